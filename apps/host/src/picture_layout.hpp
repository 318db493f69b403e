// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "canvas.hpp"

namespace picolo::host {

/// Where everything of a picture goes: the same for every canvas.
struct PictureLayout {
  double left_m = 0.0;  ///< of the plot, metres at its lower left corner
  double low_m = 0.0;
  double px_per_m = 1.0;
  PixelBox plot;
  double width_px = 0.0;  ///< of the whole canvas
  double height_px = 0.0;

  [[nodiscard]] Pixel place(const Point2<double>& point_m) const;
};

[[nodiscard]] PictureLayout lay_out(const Picture& picture);

/// 1, 2 or 5 times a power of ten, the largest not above `limit` (> 0).
[[nodiscard]] double round_step(double limit);

void draw(const Picture& picture, const PictureLayout& layout, Canvas& canvas);

}  // namespace picolo::host
