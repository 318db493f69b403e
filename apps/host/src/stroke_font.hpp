// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>
#include <vector>

#include "canvas.hpp"

namespace picolo::host {

/// A font of strokes for the raster canvas. Units: capital letters are 14 high.
inline constexpr double kCapHeight = 14.0;

/// Strokes of one glyph: y upward from the baseline, curves already smoothed.
struct Glyph {
  std::vector<std::vector<Pixel>> strokes;
  double advance = 0.0;
};

/// Printable ASCII; anything else is a box.
[[nodiscard]] Glyph stroke_glyph(char character);
[[nodiscard]] double text_width(std::string_view words, double size_px);

/// Height of a capital letter for a font size, as in common sans-serif fonts.
inline constexpr double kCapPerSize = 0.72;

}  // namespace picolo::host
