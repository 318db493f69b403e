// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/picture.hpp"

#include <utility>

#include "picolo/host/files.hpp"
#include "picture_layout.hpp"
#include "raster_canvas.hpp"
#include "svg_canvas.hpp"

namespace picolo::host {

PictureLine trajectory_line(const Trajectory& poses, Colour colour, double width_px,
                            std::string label) {
  PictureLine line{{}, colour, width_px, std::move(label)};
  line.points_m.reserve(poses.size());
  for (const TrajectoryPose& pose : poses) {
    line.points_m.push_back({pose.pose.x_m, pose.pose.y_m});
  }
  return line;
}

void write_svg(const Picture& picture, const std::filesystem::path& path) {
  const PictureLayout layout = lay_out(picture);
  SvgCanvas canvas{static_cast<std::size_t>(layout.width_px),
                   static_cast<std::size_t>(layout.height_px), palette::kPaper};
  draw(picture, layout, canvas);
  write_file(path, canvas.result());
}

void write_png(const Picture& picture, const std::filesystem::path& path) {
  const PictureLayout layout = lay_out(picture);
  RasterCanvas canvas{static_cast<std::size_t>(layout.width_px),
                      static_cast<std::size_t>(layout.height_px), palette::kPaper};
  draw(picture, layout, canvas);
  write_file(path, encode_png(canvas.result(), false));
}

void write_picture(const Picture& picture, const std::filesystem::path& folder,
                   const std::string& stem) {
  write_svg(picture, folder / (stem + ".svg"));
  write_png(picture, folder / (stem + ".png"));
}

}  // namespace picolo::host
