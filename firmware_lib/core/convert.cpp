// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/convert.hpp"

#include <limits>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

/// Adding a half before truncating would round 0.49999997F up and odd numbers above 2^23 to even
/// neighbours; the difference to the truncated value is exact instead.
/// The comparisons use the type's own bounds, which Real holds exactly (as high + 1 = -low); those
/// of the caller are applied to integers.
template <typename Integer, typename Real, typename Adjust>
Integer converted(Real value, Integer low, Integer high, Adjust adjust) {
  constexpr Real kEnd = -static_cast<Real>(std::numeric_limits<Integer>::min());
  if (!(value > -kEnd)) { return low; }  // NaN ends here
  if (value >= kEnd) { return high; }
  const auto truncated = static_cast<Integer>(value);
  const Integer rounded = truncated + adjust(value - static_cast<Real>(truncated));
  return rounded < low ? low : (rounded > high ? high : rounded);
}

template <typename Integer, typename Real>
Integer round_to(Real value, Integer low, Integer high) {
  return converted(value, low, high, [](Real rest) {
    return static_cast<Integer>(rest >= Real(0.5)) - static_cast<Integer>(rest <= Real(-0.5));
  });
}

template <typename Real>
std::int32_t floor_to(Real value, std::int32_t low, std::int32_t high) {
  return converted(value, low, high,
                   [](Real rest) { return -static_cast<std::int32_t>(rest < Real(0)); });
}

}  // namespace

std::int32_t round_to_i32(float value, std::int32_t low, std::int32_t high) {
  return round_to(value, low, high);
}

std::int64_t round_to_i64(double value, std::int64_t low, std::int64_t high) {
  return round_to(value, low, high);
}

std::int32_t floor_to_i32(float value, std::int32_t low, std::int32_t high) {
  return floor_to(value, low, high);
}

std::int32_t floor_to_i32(double value, std::int32_t low, std::int32_t high) {
  return floor_to(value, low, high);
}

}  // namespace picolo::inline v0
