// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "picture_layout.hpp"
#include "stroke_font.hpp"

namespace picolo::host {
namespace {

constexpr double kTickSpacing_px = 130.0;
constexpr double kTitleSize = 21.0;
constexpr double kTextSize = 14.0;

/// "0.25", "10": as many decimals as the step needs.
std::string tick_label(double value, double step) {
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
  return fmt::format("{:.{}f}", std::abs(value) < 1e-9 * step ? 0.0 : value, decimals);
}

ColourImage colours_of(const OccupancyImage& map) {
  ColourImage image{map.width, map.height, {}};
  image.pixels.reserve(map.cells.size());
  for (std::size_t row = map.height; row-- > 0;) {
    for (std::size_t column = 0; column < map.width; ++column) {
      const MapCell cell = map.at(column, row);
      image.pixels.push_back(
          cell == MapCell::occupied ? palette::kOccupied
          : cell == MapCell::free
              ? palette::kFree
              : Colour{palette::kUnknown.red, palette::kUnknown.green, palette::kUnknown.blue, 0});
    }
  }
  return image;
}

/// Blocks of `factor` x `factor` cells; a block with a wall is wall, so that walls thinner than a
/// pixel stay visible.
OccupancyImage coarser(const OccupancyImage& map, std::size_t factor) {
  OccupancyImage result = map;
  result.width = (map.width + factor - 1) / factor;
  result.height = (map.height + factor - 1) / factor;
  result.resolution_m = map.resolution_m * static_cast<double>(factor);
  result.cells.assign(result.width * result.height, MapCell::unknown);
  for (std::size_t row = 0; row < map.height; ++row) {
    for (std::size_t column = 0; column < map.width; ++column) {
      MapCell& block = result.cells[row / factor * result.width + column / factor];
      block = std::max(block, map.at(column, row));  // unknown < free < occupied
    }
  }
  return result;
}

void draw_map(const OccupancyImage& map, const PictureLayout& layout, Canvas& canvas) {
  const double px_per_cell = map.resolution_m * layout.px_per_m;
  const auto factor = static_cast<std::size_t>(std::max(1.0, std::ceil(1.0 / px_per_cell - 0.25)));
  const OccupancyImage shown = coarser(map, factor);
  const double width_m = static_cast<double>(shown.width) * shown.resolution_m;
  const double height_m = static_cast<double>(shown.height) * shown.resolution_m;
  const Pixel corner = layout.place({shown.origin_x_m, shown.origin_y_m + height_m});
  canvas.image({corner.x, corner.y, width_m * layout.px_per_m, height_m * layout.px_per_m},
               colours_of(shown));
}

/// Points closer than a fraction of a pixel to their predecessor are left out.
std::vector<Pixel> place_all(const std::vector<Point2<double>>& points_m,
                             const PictureLayout& layout, double closest_px) {
  std::vector<Pixel> placed;
  for (const auto& point : points_m) {
    const Pixel next = layout.place(point);
    if (std::isfinite(next.x) && std::isfinite(next.y) &&
        (placed.empty() ||
         std::hypot(next.x - placed.back().x, next.y - placed.back().y) >= closest_px)) {
      placed.push_back(next);
    }
  }
  return placed;
}

struct Ticks {
  double first = 0.0;
  double last = 0.0;
  double step = 1.0;

  template <typename Action>
  void each(Action action) const {
    for (double k = std::ceil(first / step); k * step <= last; ++k) { action(k * step); }
  }
};

Ticks ticks_x(const PictureLayout& layout) {
  return {layout.left_m, layout.left_m + layout.plot.width / layout.px_per_m,
          round_step(kTickSpacing_px / layout.px_per_m)};
}

Ticks ticks_y(const PictureLayout& layout) {
  return {layout.low_m, layout.low_m + layout.plot.height / layout.px_per_m,
          round_step(kTickSpacing_px / layout.px_per_m)};
}

void draw_grid(const PictureLayout& layout, Canvas& canvas) {
  const PixelBox& plot = layout.plot;
  ticks_x(layout).each([&](double x_m) {
    const double x = layout.place({x_m, 0.0}).x;
    canvas.fill({x - 0.5, plot.top, 1.0, plot.height}, palette::kGrid);
  });
  ticks_y(layout).each([&](double y_m) {
    const double y = layout.place({0.0, y_m}).y;
    canvas.fill({plot.left, y - 0.5, plot.width, 1.0}, palette::kGrid);
  });
}

void draw_frame(const PictureLayout& layout, Canvas& canvas) {
  const PixelBox& plot = layout.plot;
  const double bottom = plot.top + plot.height;
  const double right = plot.left + plot.width;
  ticks_x(layout).each([&](double x_m) {
    canvas.text({layout.place({x_m, 0.0}).x, bottom + 20.0}, tick_label(x_m, ticks_x(layout).step),
                {13.0, palette::kFaintInk, Anchor::middle, false, false});
  });
  ticks_y(layout).each([&](double y_m) {
    canvas.text({plot.left - 8.0, layout.place({0.0, y_m}).y + 4.5},
                tick_label(y_m, ticks_y(layout).step),
                {13.0, palette::kFaintInk, Anchor::end, false, false});
  });
  canvas.text({plot.left + 0.5 * plot.width, bottom + 46.0}, "x [m]",
              {kTextSize, palette::kInk, Anchor::middle, false, false});
  canvas.text({24.0, plot.top + 0.5 * plot.height}, "y [m]",
              {kTextSize, palette::kInk, Anchor::middle, false, true});
  canvas.polyline(
      std::array{Pixel{plot.left, plot.top}, Pixel{right, plot.top}, Pixel{right, bottom},
                 Pixel{plot.left, bottom}, Pixel{plot.left, plot.top}},
      palette::kFaintInk, 1.0);
}

void draw_scale_bar(const PictureLayout& layout, Canvas& canvas) {
  const double length_m = round_step(0.2 * layout.plot.width / layout.px_per_m);
  const double length_px = length_m * layout.px_per_m;
  const double right = layout.plot.left + layout.plot.width - 24.0;
  const double left = right - length_px;
  const double y = layout.plot.top + layout.plot.height - 22.0;
  canvas.fill({left - 12.0, y - 28.0, length_px + 24.0, 40.0}, {255, 255, 255, 215});
  for (int quarter = 0; quarter < 4; ++quarter) {
    canvas.fill({left + quarter * length_px / 4.0, y - 5.0, length_px / 4.0, 5.0},
                quarter % 2 == 0 ? palette::kInk : palette::kTruth);
  }
  canvas.text({0.5 * (left + right), y - 11.0}, tick_label(length_m, length_m) + " m",
              {13.0, palette::kInk, Anchor::middle, false, false});
}

void draw_heading(const Picture& picture, const PictureLayout& layout, Canvas& canvas) {
  const double left = layout.plot.left;
  canvas.text({left, 34.0}, picture.title, {kTitleSize, palette::kInk, Anchor::start, true, false});
  canvas.text({left, 59.0}, picture.note,
              {kTextSize, palette::kFaintInk, Anchor::start, false, false});
  double x = left;
  const double y = 86.0;
  const auto entry = [&](const std::string& label) {
    canvas.text({x + 36.0, y}, label, {kTextSize, palette::kInk, Anchor::start, false, false});
    x += 36.0 + text_width(label, kTextSize) + 36.0;
  };
  for (const PicturePoints& points : picture.points) {
    if (!points.label.empty()) {
      canvas.dots(std::array{Pixel{x + 8.0, y - 5.0}, Pixel{x + 20.0, y - 5.0}}, points.colour,
                  std::max(points.radius_px, 2.5));
      entry(points.label);
    }
  }
  for (const PictureLine& line : picture.lines) {
    if (!line.label.empty()) {
      canvas.polyline(std::array{Pixel{x, y - 5.0}, Pixel{x + 28.0, y - 5.0}}, line.colour,
                      line.width_px + 0.5);
      entry(line.label);
    }
  }
}

}  // namespace

void draw(const Picture& picture, const PictureLayout& layout, Canvas& canvas) {
  const PixelBox whole{0.0, 0.0, layout.width_px, layout.height_px};
  const bool known_space =
      std::any_of(picture.maps.begin(), picture.maps.end(), [](const OccupancyImage& map) {
        return std::find(map.cells.begin(), map.cells.end(), MapCell::free) != map.cells.end();
      });
  draw_heading(picture, layout, canvas);
  canvas.clip(layout.plot);
  if (known_space) { canvas.fill(layout.plot, palette::kUnknown); }
  for (const OccupancyImage& map : picture.maps) { draw_map(map, layout, canvas); }
  draw_grid(layout, canvas);
  for (const PicturePoints& points : picture.points) {
    canvas.dots(place_all(points.points_m, layout, 0.0), points.colour, points.radius_px);
  }
  for (const PictureLine& line : picture.lines) {
    canvas.polyline(place_all(line.points_m, layout, 0.3), line.colour, line.width_px);
  }
  draw_scale_bar(layout, canvas);
  canvas.clip(whole);
  draw_frame(layout, canvas);
}

}  // namespace picolo::host
