// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Range reduction to a short interval, then a Taylor polynomial whose first left-out term is below
// half an ulp.

#include "picolo/core/math.hpp"

#include <bit>
#include <cstdint>

#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/core/soft_double.hpp"

namespace picolo::inline v0 {
namespace {

/// c0 + x (c1 + x (c2 + ...)), from the last coefficient to the first.
template <typename T, std::size_t N>
T polynomial(T x, const T (&coefficients)[N]) {
  T sum = coefficients[N - 1];
  for (std::size_t i = N - 1; i-- > 0;) { sum = sum * x + coefficients[i]; }
  return sum;
}

// sin(r) / r and cos(r) in powers of r^2, |r| <= pi/4.
constexpr float kSineF32[] = {1.0F, -1.0F / 6.0F, 1.0F / 120.0F, -1.0F / 5040.0F, 1.0F / 362880.0F};
constexpr float kCosineF32[] = {1.0F,           -0.5F,           1.0F / 24.0F,
                                -1.0F / 720.0F, 1.0F / 40320.0F, -1.0F / 3628800.0F};
constexpr double kSineF64[] = {1.0,
                               -1.0 / 6.0,
                               1.0 / 120.0,
                               -1.0 / 5040.0,
                               1.0 / 362880.0,
                               -1.0 / 39916800.0,
                               1.0 / 6227020800.0,
                               -1.0 / 1307674368000.0,
                               1.0 / 355687428096000.0};
constexpr double kCosineF64[] = {1.0,
                                 -0.5,
                                 1.0 / 24.0,
                                 -1.0 / 720.0,
                                 1.0 / 40320.0,
                                 -1.0 / 3628800.0,
                                 1.0 / 479001600.0,
                                 -1.0 / 87178291200.0,
                                 1.0 / 20922789888000.0};

template <typename T>
SinCos<T> turn_by_quadrant(T sine, T cosine, std::uint32_t quadrant) {
  const bool swap = (quadrant & 1U) != 0;
  const T s = swap ? cosine : sine;
  const T c = swap ? sine : cosine;
  return {(quadrant & 2U) != 0 ? -s : s, ((quadrant + 1U) & 2U) != 0 ? -c : c};
}

// atan(k / 4) and atan(k / 8) for the nearest knot.
constexpr float kArcTangentKnotsF32[] = {0.0F, 0.24497866312686414F, 0.46364760900080615F,
                                         0.6435011087932844F, 0.7853981633974483F};
constexpr double kArcTangentKnotsF64[] = {0.0,
                                          0.12435499454676144,
                                          0.24497866312686414,
                                          0.35877067027057225,
                                          0.46364760900080615,
                                          0.5585993153435624,
                                          0.6435011087932844,
                                          0.7188299996216245,
                                          0.7853981633974483};
// atan(z) / z in powers of z^2.
constexpr float kArcTangentF32[] = {1.0F, -1.0F / 3.0F, 1.0F / 5.0F, -1.0F / 7.0F};
constexpr double kArcTangentF64[] = {1.0,       -1.0 / 3.0,  1.0 / 5.0, -1.0 / 7.0,
                                     1.0 / 9.0, -1.0 / 11.0, 1.0 / 13.0};

/// The first-octant angle from the nearest knot k / Steps: atan(t) = atan(c) + atan((t - c) / (1 +
/// t c)), t = low / high.
template <int Steps, typename T, std::size_t Knots, std::size_t Terms>
T arc_tangent_ratio(T low, T high, const T (&knots)[Knots], const T (&terms)[Terms]) {
  const std::int32_t knot =
      round_to_i32(static_cast<float>(low / high) * static_cast<float>(Steps), 0, Steps);
  const T c = static_cast<T>(knot) / static_cast<T>(Steps);
  const T z = (low - c * high) / (high + c * low);
  return knots[knot] + z * polynomial(z * z, terms);
}

template <int Steps, typename T, std::size_t Knots, std::size_t Terms>
T arc_tangent2_of(T y, T x, const T (&knots)[Knots], const T (&terms)[Terms], T pi) {
  if (!(x == x) || !(y == y)) { return x + y; }
  const T ax = x < T{0} ? -x : x;
  const T ay = y < T{0} ? -y : y;
  const T high = ax > ay ? ax : ay;
  const T low = ax > ay ? ay : ax;
  if (high == T{0}) { return T{0}; }
  T angle = low == high
                ? pi / T{4}
                : (is_finite(high) ? arc_tangent_ratio<Steps>(low, high, knots, terms) : T{0});
  if (ay > ax) { angle = pi / T{2} - angle; }
  if (x < T{0}) { angle = pi - angle; }
  return y < T{0} ? -angle : angle;
}

// exp(r), |r| <= ln(2) / 2.
constexpr float kExponentialF32[] = {1.0F,         1.0F,          0.5F,          1.0F / 6.0F,
                                     1.0F / 24.0F, 1.0F / 120.0F, 1.0F / 720.0F, 1.0F / 5040.0F};
constexpr double kExponentialF64[] = {1.0,
                                      1.0,
                                      0.5,
                                      1.0 / 6.0,
                                      1.0 / 24.0,
                                      1.0 / 120.0,
                                      1.0 / 720.0,
                                      1.0 / 5040.0,
                                      1.0 / 40320.0,
                                      1.0 / 362880.0,
                                      1.0 / 3628800.0,
                                      1.0 / 39916800.0,
                                      1.0 / 479001600.0,
                                      1.0 / 6227020800.0};

float power_of_two_f32(std::int32_t exponent) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(exponent + 127) << 23);
}
double power_of_two_f64(std::int32_t exponent) {
  return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + 1023) << 52);
}

// log(m) = 2 s (1 + s^2 / 3 + s^4 / 5 + ...), s = (m - 1) / (m + 1), m in [sqrt(1/2), sqrt(2)].
constexpr float kLogarithmF32[] = {1.0F, 1.0F / 3.0F, 1.0F / 5.0F, 1.0F / 7.0F, 1.0F / 9.0F};
constexpr double kLogarithmF64[] = {1.0,        1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,
                                    1.0 / 9.0,  1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0,
                                    1.0 / 17.0, 1.0 / 19.0, 1.0 / 21.0};
constexpr float kNan32 = std::numeric_limits<float>::quiet_NaN();
constexpr double kNan64 = std::numeric_limits<double>::quiet_NaN();

}  // namespace

SinCos<float> sin_cos(float angle_rad) {
  constexpr std::int32_t kLimit = 1 << 20;
  const std::int32_t quadrant = round_to_i32(angle_rad * 0.636619772367581343F, -kLimit, kLimit);
  const auto n = static_cast<float>(quadrant);
  // pi/2 in three parts; the first two have trailing zero bits, so that n times them is exact (Cody
  // and Waite).
  const float r = ((angle_rad - n * 1.5703125F) - n * 4.83751296997e-4F) - n * 7.54978995489e-8F;
  const float r2 = r * r;
  return turn_by_quadrant(r * polynomial(r2, kSineF32), polynomial(r2, kCosineF32),
                          static_cast<std::uint32_t>(quadrant));
}

SinCos<double> sin_cos(double angle_rad) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 30;
  const std::int64_t quadrant = round_to_i64(angle_rad * 0.636619772367581343, -kLimit, kLimit);
  const auto n = static_cast<double>(quadrant);
  const double r =
      ((angle_rad - n * 0x1.921FB544p0) - n * 0x1.0B4611A6p-34) - n * 0x1.3198A2E037073p-69;
  const double r2 = r * r;
  return turn_by_quadrant(r * polynomial(r2, kSineF64), polynomial(r2, kCosineF64),
                          static_cast<std::uint32_t>(quadrant & 3));
}

float arc_tangent2(float y, float x) {
  return arc_tangent2_of<4>(y, x, kArcTangentKnotsF32, kArcTangentF32, 3.14159265358979F);
}

double arc_tangent2(double y, double x) {
  return arc_tangent2_of<8>(y, x, kArcTangentKnotsF64, kArcTangentF64, 3.14159265358979324);
}

float exponential(float x) {
  if (!(x == x)) { return x; }
  if (x > 88.72283F) { return std::numeric_limits<float>::infinity(); }
  if (x < -87.33654F) { return 0.0F; }
  const std::int32_t n = round_to_i32(x * 1.44269504088896341F, -126, 128);
  const auto count = static_cast<float>(n);
  const float r = (x - count * 0.693359375F) + count * 2.12194440e-4F;
  const std::int32_t half = n / 2;  // 2^128 is not a float: scale in two steps
  return polynomial(r, kExponentialF32) * power_of_two_f32(half) * power_of_two_f32(n - half);
}

double exponential(double x) {
  if (!(x == x)) { return x; }
  if (x > 709.78271289338397) { return std::numeric_limits<double>::infinity(); }
  if (x < -708.39641853226408) { return 0.0; }
  const auto n = static_cast<std::int32_t>(round_to_i64(x * 1.44269504088896341, -1022, 1024));
  const auto count = static_cast<double>(n);
  const double r = (x - count * 0x1.62E42FEEp-1) - count * 0x1.A39EF35793C76p-33;
  const std::int32_t half = n / 2;
  return polynomial(r, kExponentialF64) * power_of_two_f64(half) * power_of_two_f64(n - half);
}

float logarithm(float x) {
  if (!(x > 0.0F)) { return kNan32; }
  if (!is_finite(x)) { return x; }
  std::int32_t exponent = 0;
  if (x < std::numeric_limits<float>::min()) {
    x *= 0x1p24F;
    exponent = -24;
  }
  // Subtracting the bits of sqrt(1/2) splits x into 2^e * m with m in [sqrt(1/2), sqrt(2)).
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(x) - 0x3F3504F3U;
  exponent += std::bit_cast<std::int32_t>(bits) >> 23;
  const float m = std::bit_cast<float>((bits & 0x007FFFFFU) + 0x3F3504F3U);
  const float s = (m - 1.0F) / (m + 1.0F);
  const auto count = static_cast<float>(exponent);
  return count * 0.693359375F +
         (2.0F * s * polynomial(s * s, kLogarithmF32) - count * 2.12194440e-4F);
}

double logarithm(double x) {
  if (!(x > 0.0)) { return kNan64; }
  if (!is_finite(x)) { return x; }
  std::int32_t exponent = 0;
  if (x < std::numeric_limits<double>::min()) {
    x *= 0x1p54;
    exponent = -54;
  }
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(x) - 0x3FE6A09E667F3BCDULL;
  exponent += static_cast<std::int32_t>(std::bit_cast<std::int64_t>(bits) >> 52);
  const double m = std::bit_cast<double>((bits & 0x000FFFFFFFFFFFFFULL) + 0x3FE6A09E667F3BCDULL);
  const double s = (m - 1.0) / (m + 1.0);
  const auto count = static_cast<double>(exponent);
  return count * 0x1.62E42FEEp-1 +
         (2.0 * s * polynomial(s * s, kLogarithmF64) + count * 0x1.A39EF35793C76p-33);
}

float square_root(float x) {
  return __builtin_sqrtf(x);
}

// Without double-precision hardware the builtin would be a call of libm.
double square_root(double x) {
#if defined(__arm__) && (!defined(__ARM_FP) || (__ARM_FP & 8) == 0)
  return std::bit_cast<double>(soft_double::square_root(std::bit_cast<std::uint64_t>(x)));
#else
  return __builtin_sqrt(x);
#endif
}

float hypotenuse(float x, float y) {
  return square_root(x * x + y * y);
}

double hypotenuse(double x, double y) {
  return square_root(x * x + y * y);
}

bool is_finite(float x) {
  return (std::bit_cast<std::uint32_t>(x) & 0x7F800000U) != 0x7F800000U;
}

bool is_finite(double x) {
  return (std::bit_cast<std::uint64_t>(x) & 0x7FF0000000000000ULL) != 0x7FF0000000000000ULL;
}

}  // namespace picolo::inline v0
