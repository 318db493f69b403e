// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The kernels behind plain types, so that two builds of them can be called side by side.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace kernels {

struct Input {
  const std::uint8_t* cells;
  int width;
  int height;
  const float* x_m;
  const float* y_m;
  const std::int8_t* along_x;  ///< null: without surfaces
  const std::int8_t* along_y;
  std::size_t points;
  float pose_x_m;
  float pose_y_m;
  float sine;
  float cosine;
  float inverse_kernel_squared;
};

/// Fourteen sums and the cost.
using Output = std::array<float, 15>;

Output plain(const Input& input);
Output with_avx2(const Input& input);

}  // namespace kernels
