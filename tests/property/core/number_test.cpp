// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Conversions, time, elementary functions and random numbers over their whole domains.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/random.hpp"
#include "picolo/core/time.hpp"
#include "support/property.hpp"

namespace picolo {
namespace {

using test::number;

RC_GTEST_PROP(ConvertLaws, AnyBitsGiveAValueBetweenTheBounds,
              (std::uint32_t bits, std::int32_t a, std::int32_t b)) {
  const std::int32_t low = std::min(a, b);
  const std::int32_t high = std::max(a, b);
  const auto value = std::bit_cast<float>(bits);
  for (const std::int32_t result : {round_to_i32(value, low, high), floor_to_i32(value, low, high),
                                    floor_to_i32(static_cast<double>(value), low, high)}) {
    RC_ASSERT(result >= low && result <= high);
  }
  const auto wide =
      std::bit_cast<double>((std::uint64_t{bits} << 32) | static_cast<std::uint32_t>(a));
  RC_ASSERT(round_to_i64(wide, low, high) >= low && round_to_i64(wide, low, high) <= high);
}

RC_GTEST_PROP(ConvertLaws, RoundingMovesByAtMostAHalfAndFloorByLessThanOneDown, ()) {
  const double value = *number(-2e9, 2e9) * *rc::gen::element(1.0, 1e-3, 1e-8);
  const auto single = static_cast<float>(value);
  const double exact = static_cast<double>(single);
  RC_ASSERT(std::abs(round_to_i32(single, INT32_MIN, INT32_MAX) - exact) <= 0.5);
  const double below = exact - floor_to_i32(single, INT32_MIN, INT32_MAX);
  RC_ASSERT(below >= 0.0 && below < 1.0);
}

RC_GTEST_PROP(ConvertLaws, ConversionsAreMonotonicAndOdd, ()) {
  const auto a = static_cast<float>(*number(-1e6, 1e6));
  const auto b = static_cast<float>(*number(-1e6, 1e6));
  const float low = std::min(a, b);
  const float high = std::max(a, b);
  RC_ASSERT(round_to_i32(low, INT32_MIN, INT32_MAX) <= round_to_i32(high, INT32_MIN, INT32_MAX));
  RC_ASSERT(floor_to_i32(low, INT32_MIN, INT32_MAX) <= floor_to_i32(high, INT32_MIN, INT32_MAX));
  RC_ASSERT(round_to_i32(-a, INT32_MIN, INT32_MAX) == -round_to_i32(a, INT32_MIN, INT32_MAX));
}

RC_GTEST_PROP(TimeLaws, MicrosecondsSurviveTheWayThroughSeconds, ()) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 51;  // 71 years
  const Duration duration{*rc::gen::inRange<std::int64_t>(-kLimit, kLimit)};
  RC_ASSERT(from_seconds(to_seconds_f64(duration)) == duration);
}

RC_GTEST_PROP(MathLaws, SineAndCosineLieOnTheCircleAndKnowTheirSymmetries, ()) {
  const double angle = *number(-1e5, 1e5);
  const SinCos<double> at = sin_cos(angle);
  RC_ASSERT(std::abs(at.sine * at.sine + at.cosine * at.cosine - 1.0) <= 1e-15);
  RC_ASSERT(sin_cos(-angle).sine == -at.sine);
  RC_ASSERT(sin_cos(-angle).cosine == at.cosine);
  const auto single = static_cast<float>(*number(-1e3, 1e3));
  const SinCos<float> f = sin_cos(single);
  RC_ASSERT(std::abs(f.sine * f.sine + f.cosine * f.cosine - 1.0F) <= 5e-7F);
  RC_ASSERT(sin_cos(-single).sine == -f.sine);
}

RC_GTEST_PROP(MathLaws, ArcTangentFindsTheAngleOfSineAndCosine, ()) {
  const double angle = *number(-3.14159, 3.14159);
  const double scale = std::exp(*number(-20.0, 20.0));
  const SinCos<double> at = sin_cos(angle);
  RC_ASSERT(std::abs(arc_tangent2(scale * at.sine, scale * at.cosine) - angle) <= 2e-15);
  const SinCos<float> f = sin_cos(static_cast<float>(angle));
  RC_ASSERT(std::abs(static_cast<double>(arc_tangent2(f.sine, f.cosine)) - angle) <= 1e-6);
}

RC_GTEST_PROP(MathLaws, LogarithmUndoesExponential, ()) {
  const double x = *number(-700.0, 700.0);
  RC_ASSERT(std::abs(logarithm(exponential(x)) - x) <= 1e-15 * std::max(1.0, std::abs(x)));
  const auto single = static_cast<float>(*number(-80.0, 80.0));
  RC_ASSERT(std::abs(logarithm(exponential(single)) - single) <=
            5e-7F * std::max(1.0F, std::abs(single)));
}

RC_GTEST_PROP(MathLaws, AnyBitsGoThroughWithoutAHang,
              (std::uint64_t y_bits, std::uint64_t x_bits)) {
  const auto y = std::bit_cast<double>(y_bits);
  const auto x = std::bit_cast<double>(x_bits);
  RC_ASSERT(std::isnan(arc_tangent2(y, x)) == (std::isnan(x) || std::isnan(y)));
  RC_ASSERT(std::isnan(logarithm(x)) == !(x > 0.0));
  RC_ASSERT(std::isnan(exponential(x)) == std::isnan(x));
  RC_ASSERT(is_finite(x) == std::isfinite(x));
  const auto single = std::bit_cast<float>(static_cast<std::uint32_t>(x_bits));
  RC_ASSERT(is_finite(single) == std::isfinite(single));
  RC_ASSERT(std::isnan(exponential(single)) == std::isnan(single));
  if (single >= 0.0F) { RC_ASSERT(square_root(single) == std::sqrt(single)); }
}

RC_GTEST_PROP(RandomLaws, DrawsStayInTheirIntervals, (std::uint64_t seed, std::uint32_t bound)) {
  Random random{seed};
  const std::uint32_t draw = random.below(bound);
  const bool inside = bound == 0 ? draw == 0 : draw < bound;
  RC_ASSERT(inside);
  const double low = *number(-1e6, 1e6);
  const double high = low + *number(1e-3, 1e6);
  const double uniform = random.uniform(low, high);
  RC_ASSERT(uniform >= low && uniform <= high);
  RC_ASSERT(std::isfinite(random.gaussian()));
}

}  // namespace
}  // namespace picolo
