// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "canvas.hpp"

namespace picolo::host {

/// Anti-aliased drawing into memory: coverage is the distance to the shape's edge, clipped to one
/// pixel.
class RasterCanvas final : public Canvas {
 public:
  RasterCanvas(std::size_t width, std::size_t height, Colour background);

  void fill(const PixelBox& box, Colour colour) override;
  void polyline(std::span<const Pixel> points, Colour colour, double width_px) override;
  void dots(std::span<const Pixel> centres, Colour colour, double radius_px) override;
  void text(Pixel at, const std::string& words, const TextStyle& style) override;
  void image(const PixelBox& box, const ColourImage& pixels) override;
  void clip(const PixelBox& box) override;

  [[nodiscard]] const ColourImage& result() const { return image_; }

 private:
  struct Window {  // whole pixels, end exclusive
    std::size_t left, top, right, bottom;
  };

  [[nodiscard]] Window window(double left, double top, double right, double bottom) const;
  void cover_segment(Pixel from, Pixel to, double half_width_px);
  void blend_cover(Colour colour);
  void blend(std::size_t column, std::size_t row, Colour colour, double cover);

  ColourImage image_;
  PixelBox clip_;
  std::vector<float> cover_;  // of the shape being drawn, all zero in between
  Window dirty_;
};

/// PNG file content, 8 bit RGB or RGBA. Throws UserError (device) when libpng fails.
[[nodiscard]] std::string encode_png(const ColourImage& image, bool with_alpha);

}  // namespace picolo::host
