// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The one raw conversion of the library, for kernels that have already bounded the value.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// Truncates. Precondition: 0 <= value < 2^31; the caller's own comparison has excluded NaN.
inline std::int32_t truncate_bounded(float value) {
  return static_cast<std::int32_t>(value);
}

}  // namespace picolo::inline v0
