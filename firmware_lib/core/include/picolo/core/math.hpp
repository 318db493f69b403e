// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Elementary functions that give the same bits on every platform: own polynomials over + - * / and
/// sqrt, which IEEE 754 defines exactly; libm does not (glibc and newlib differ by 1-2 ulp, glibc
/// with itself by CPU). Stated errors are maxima measured by tests/unit/core against long double.
/// Cost: 30 to 80 instructions. Context: any. NaN in, NaN out.
#pragma once

namespace picolo::inline v0 {

template <typename T>
struct SinCos {
  T sine{};
  T cosine{};
};

/// Absolute error <= 1.2e-7 (float) for |angle| <= 1000 rad, <= 3e-16 (double) for |angle| <= 1e5
/// rad.
[[nodiscard]] SinCos<float> sin_cos(float angle_rad);
[[nodiscard]] SinCos<double> sin_cos(double angle_rad);

/// In (-pi, pi]; error <= 3e-7 (float), <= 5e-16 (double); (0, 0) gives 0.
[[nodiscard]] float arc_tangent2(float y, float x);
[[nodiscard]] double arc_tangent2(double y, double x);

/// Relative error <= 2e-7 (float), <= 4e-16 (double); overflow gives infinity, underflow zero.
[[nodiscard]] float exponential(float x);
[[nodiscard]] double exponential(double x);

/// Natural logarithm; x <= 0 gives NaN, infinity gives infinity. Error relative to max(1, |log x|):
/// <= 2e-7, <= 4e-16.
[[nodiscard]] float logarithm(float x);
[[nodiscard]] double logarithm(double x);

/// Correctly rounded (one instruction where the processor has it). x < 0 gives NaN.
[[nodiscard]] float square_root(float x);
[[nodiscard]] double square_root(double x);

[[nodiscard]] float hypotenuse(float x, float y);
[[nodiscard]] double hypotenuse(double x, double y);

[[nodiscard]] bool is_finite(float x);
[[nodiscard]] bool is_finite(double x);

}  // namespace picolo::inline v0
