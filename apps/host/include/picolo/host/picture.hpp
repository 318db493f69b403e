// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One model of a drawing in metres, rendered to SVG and to PNG alike: maps, points, lines, with
/// axes, legend, scale bar and title.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "picolo/geometry/pose2.hpp"
#include "picolo/host/map_file.hpp"
#include "picolo/host/trajectory.hpp"

namespace picolo::host {

struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t alpha = 255;
  [[nodiscard]] friend constexpr bool operator==(const Colour&, const Colour&) = default;
};

/// The colours that mean the same on every picture of the project.
namespace palette {
inline constexpr Colour kPaper{255, 255, 255};
inline constexpr Colour kInk{38, 41, 48};
inline constexpr Colour kFaintInk{120, 125, 134};
inline constexpr Colour kGrid{0, 0, 0, 22};
inline constexpr Colour kOccupied{24, 25, 29};
inline constexpr Colour kFree{255, 255, 255};
inline constexpr Colour kUnknown{226, 228, 232};
inline constexpr Colour kOdometry{214, 39, 40};
inline constexpr Colour kPicolo{22, 150, 66};
inline constexpr Colour kTruth{150, 153, 160};
}  // namespace palette

struct PictureLine {
  std::vector<Point2<double>> points_m;
  Colour colour = palette::kInk;
  double width_px = 2.0;
  std::string label;  ///< in the legend; empty: not there
};

struct PicturePoints {
  std::vector<Point2<double>> points_m;
  Colour colour = palette::kInk;
  double radius_px = 1.5;
  std::string label;
};

struct Picture {
  std::string title;
  std::string note;                  ///< one smaller line under the title
  std::vector<OccupancyImage> maps;  ///< lowest layer
  std::vector<PicturePoints> points;
  std::vector<PictureLine> lines;              ///< in this order, the last on top
  std::vector<Point2<double>> keep_in_view_m;  ///< for pictures that are to be compared
  int plot_width_px = 1100;
};

[[nodiscard]] PictureLine trajectory_line(const Trajectory& poses, Colour colour, double width_px,
                                          std::string label);

/// Throws UserError (usage, device).
void write_svg(const Picture& picture, const std::filesystem::path& path);
void write_png(const Picture& picture, const std::filesystem::path& path);
/// STEM.svg and STEM.png.
void write_picture(const Picture& picture, const std::filesystem::path& folder,
                   const std::string& stem);

}  // namespace picolo::host
