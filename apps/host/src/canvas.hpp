// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "picolo/host/picture.hpp"

namespace picolo::host {

/// A point of the canvas: x to the right, y downward, from the top left corner.
struct Pixel {
  double x = 0.0;
  double y = 0.0;
};

struct PixelBox {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;
};

/// Row-major from the top left corner.
struct ColourImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Colour> pixels;
};

enum class Anchor { start, middle, end };

struct TextStyle {
  double size_px = 14.0;
  Colour colour = palette::kInk;
  Anchor anchor = Anchor::start;
  bool bold = false;
  bool upward = false;  ///< turned by a quarter, reading from bottom to top
};

/// What a picture is drawn with.
class Canvas {
 public:
  virtual ~Canvas() = default;
  virtual void fill(const PixelBox& box, Colour colour) = 0;
  virtual void polyline(std::span<const Pixel> points, Colour colour, double width_px) = 0;
  virtual void dots(std::span<const Pixel> centres, Colour colour, double radius_px) = 0;
  /// `at` is on the baseline.
  virtual void text(Pixel at, const std::string& words, const TextStyle& style) = 0;
  virtual void image(const PixelBox& box, const ColourImage& pixels) = 0;
  /// Whatever follows is drawn inside of `box` only, until the next call.
  virtual void clip(const PixelBox& box) = 0;
};

}  // namespace picolo::host
