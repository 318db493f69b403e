// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Curves over a common abscissa, in panels one above the other, as SVG and PNG.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "picolo/host/picture.hpp"

namespace picolo::host {

struct Curve {
  std::vector<double> x;  ///< as many as y
  std::vector<double> y;
  Colour colour = palette::kInk;
  double width_px = 2.0;
  std::string label;  ///< in the legend, once however many panels carry it; empty: not there
};

struct Panel {
  std::string y_label;
  std::vector<Curve> curves;
};

struct Chart {
  std::string title;
  std::string note;
  std::string x_label;
  std::vector<Panel> panels;
};

/// STEM.svg and STEM.png. Throws UserError (usage, device).
void write_chart(const Chart& chart, const std::filesystem::path& folder, const std::string& stem);

}  // namespace picolo::host
