// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picture_layout.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace picolo::host {
namespace {

constexpr double kMarginLeft = 76.0;
constexpr double kMarginRight = 28.0;
constexpr double kMarginTop = 104.0;
constexpr double kMarginBottom = 62.0;
constexpr double kSmallestPlotHeight = 420.0;
constexpr double kLargestPlotHeight = 1100.0;
constexpr double kPadding = 0.04;  // of the larger side, free around the drawing
constexpr double kSmallestSide_m = 1.0;

struct Bounds {
  double left = std::numeric_limits<double>::infinity();
  double right = -std::numeric_limits<double>::infinity();
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void add(double x, double y) {
    if (std::isfinite(x) && std::isfinite(y)) {
      left = std::min(left, x);
      right = std::max(right, x);
      low = std::min(low, y);
      high = std::max(high, y);
    }
  }
  void add(const std::vector<Point2<double>>& points_m) {
    for (const auto& point : points_m) { add(point.x_m, point.y_m); }
  }
};

Bounds bounds_of(const Picture& picture) {
  Bounds bounds;
  for (const OccupancyImage& map : picture.maps) {
    bounds.add(map.origin_x_m, map.origin_y_m);
    bounds.add(map.origin_x_m + static_cast<double>(map.width) * map.resolution_m,
               map.origin_y_m + static_cast<double>(map.height) * map.resolution_m);
  }
  for (const PicturePoints& points : picture.points) { bounds.add(points.points_m); }
  for (const PictureLine& line : picture.lines) { bounds.add(line.points_m); }
  bounds.add(picture.keep_in_view_m);
  if (!(bounds.left <= bounds.right)) { bounds.add(0.0, 0.0); }
  return bounds;
}

}  // namespace

Pixel PictureLayout::place(const Point2<double>& point_m) const {
  return {plot.left + (point_m.x_m - left_m) * px_per_m,
          plot.top + plot.height - (point_m.y_m - low_m) * px_per_m};
}

double round_step(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  double step = power;
  for (const double factor : std::array{2.0, 5.0, 10.0}) {
    if (factor * power <= limit * (1.0 + 1e-9)) { step = factor * power; }
  }
  return step;
}

PictureLayout lay_out(const Picture& picture) {
  const Bounds bounds = bounds_of(picture);
  const double padding_m =
      kPadding * std::max({bounds.right - bounds.left, bounds.high - bounds.low, kSmallestSide_m});
  const double width_m = std::max(bounds.right - bounds.left, kSmallestSide_m) + 2.0 * padding_m;
  const double height_m = std::max(bounds.high - bounds.low, kSmallestSide_m) + 2.0 * padding_m;
  PictureLayout layout;
  layout.plot = {kMarginLeft, kMarginTop, static_cast<double>(picture.plot_width_px), 0.0};
  layout.plot.height = std::round(
      std::clamp(layout.plot.width * height_m / width_m, kSmallestPlotHeight, kLargestPlotHeight));
  layout.px_per_m = std::min(layout.plot.width / width_m, layout.plot.height / height_m);
  layout.left_m = 0.5 * (bounds.left + bounds.right - layout.plot.width / layout.px_per_m);
  layout.low_m = 0.5 * (bounds.low + bounds.high - layout.plot.height / layout.px_per_m);
  layout.width_px = kMarginLeft + layout.plot.width + kMarginRight;
  layout.height_px = kMarginTop + layout.plot.height + kMarginBottom;
  return layout;
}

}  // namespace picolo::host
