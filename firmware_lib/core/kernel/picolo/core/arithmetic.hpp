// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What formulas are written in, for float and double. std::abs would be a call of libm at -O0.
#pragma once

namespace picolo::inline v0 {

template <typename T>
[[nodiscard]] constexpr T magnitude(T x) {
  return x < T{0} ? -x : x;
}

template <typename T>
[[nodiscard]] constexpr T square(T x) {
  return x * x;
}

}  // namespace picolo::inline v0
