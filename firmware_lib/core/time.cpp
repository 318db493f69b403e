// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/time.hpp"

#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

float to_seconds(Duration duration) {
  return static_cast<float>(duration.count()) * 1e-6F;
}

double to_seconds_f64(Duration duration) {
  return static_cast<double>(duration.count()) / 1e6;
}

Duration from_seconds(double seconds_s) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 62;
  if (!(seconds_s == seconds_s)) { return Duration{0}; }
  return Duration{round_to_i64(seconds_s * 1e6, -kLimit, kLimit)};
}

}  // namespace picolo::inline v0
