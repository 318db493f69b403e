// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Grey pictures of the netpbm family.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace picolo::host {

struct GreyImage {
  std::size_t width = 0;
  std::size_t height = 0;
  int white = 255;
  std::vector<int> greys;  ///< top row first, 0 (black) to `white`
};

/// P2 (text) or P5 (binary). Throws UserError (input).
[[nodiscard]] GreyImage read_pgm(const std::filesystem::path& path);

}  // namespace picolo::host
