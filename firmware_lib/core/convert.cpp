// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/convert.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

/// Truncates towards zero after clamping; the bounds of Integer are far inside of Real's range.
template <typename Integer, typename Real>
Integer clamp_to(Real value, Integer low, Integer high) {
  if (!(value > static_cast<Real>(low))) { return low; }  // NaN ends here
  if (value >= static_cast<Real>(high)) { return high; }
  return static_cast<Integer>(value);
}

template <typename Integer, typename Real>
Integer floor_to(Real value, Integer low, Integer high) {
  const Integer truncated = clamp_to(value, low, high);
  return truncated > low && static_cast<Real>(truncated) > value ? truncated - 1 : truncated;
}

}  // namespace

std::int32_t round_to_i32(float value, std::int32_t low, std::int32_t high) {
  return clamp_to(value < 0.0F ? value - 0.5F : value + 0.5F, low, high);
}

std::int64_t round_to_i64(double value, std::int64_t low, std::int64_t high) {
  return clamp_to(value < 0.0 ? value - 0.5 : value + 0.5, low, high);
}

std::int32_t floor_to_i32(float value, std::int32_t low, std::int32_t high) {
  return floor_to(value, low, high);
}

std::int32_t floor_to_i32(double value, std::int32_t low, std::int32_t high) {
  return floor_to(value, low, high);
}

}  // namespace picolo::inline v0
