// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "canvas.hpp"

namespace picolo::host {

class SvgCanvas final : public Canvas {
 public:
  SvgCanvas(std::size_t width, std::size_t height, Colour background);

  void fill(const PixelBox& box, Colour colour) override;
  void polyline(std::span<const Pixel> points, Colour colour, double width_px) override;
  void dots(std::span<const Pixel> centres, Colour colour, double radius_px) override;
  void text(Pixel at, const std::string& words, const TextStyle& style) override;
  void image(const PixelBox& box, const ColourImage& pixels) override;
  void clip(const PixelBox& box) override;

  /// The finished document.
  [[nodiscard]] std::string result() const { return body_ + "</g>\n</svg>\n"; }

 private:
  std::string body_;
  int clips_ = 0;
};

}  // namespace picolo::host
