// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sensing/ranging.hpp"

#include <numbers>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int32_t kManyTurns = 1 << 30;

bool is_index(double refractive_index) {
  return refractive_index >= 1.0 && is_finite(refractive_index);
}

}  // namespace

Result<double> time_of_flight_range_m(double round_trip_s, double refractive_index) {
  if (!(round_trip_s >= 0.0) || !is_finite(round_trip_s) || !is_index(refractive_index)) {
    return Status::invalid_argument;
  }
  return kSpeedOfLight_mps * round_trip_s / (2.0 * refractive_index);
}

Result<double> ambiguity_interval_m(double modulation_hz, double refractive_index) {
  if (!(modulation_hz > 0.0) || !is_finite(modulation_hz) || !is_index(refractive_index)) {
    return Status::invalid_argument;
  }
  return kSpeedOfLight_mps / (2.0 * refractive_index * modulation_hz);
}

Result<double> phase_shift_time_s(double phase_rad, double modulation_hz) {
  if (!is_finite(phase_rad) || !(modulation_hz > 0.0) || !is_finite(modulation_hz)) {
    return Status::invalid_argument;
  }
  return phase_rad / (2.0 * std::numbers::pi * modulation_hz);
}

Result<double> phase_shift_range_m(double phase_rad, double modulation_hz,
                                   double refractive_index) {
  const Result<double> interval_m = ambiguity_interval_m(modulation_hz, refractive_index);
  if (!interval_m) { return interval_m.status(); }
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  const double turns = phase_rad / kTurn_rad;
  if (!(turns > -kManyTurns && turns < kManyTurns)) { return Status::invalid_argument; }
  const double share = turns - static_cast<double>(floor_to_i32(turns, -kManyTurns, kManyTurns));
  const Result<double> round_trip_s = phase_shift_time_s(share * kTurn_rad, modulation_hz);
  if (!round_trip_s) { return round_trip_s.status(); }
  const Result<double> range_m = time_of_flight_range_m(*round_trip_s, refractive_index);
  if (!range_m) { return range_m.status(); }
  return *range_m < *interval_m ? *range_m : 0.0;  // a phase just below a full turn may round up
}

Result<double> resolve_ambiguity_m(double range_m, double interval_m, double coarse_range_m) {
  if (!(interval_m > 0.0) || !is_finite(interval_m) || !(range_m >= 0.0) || !is_finite(range_m) ||
      !(coarse_range_m >= 0.0) || !is_finite(coarse_range_m)) {
    return Status::invalid_argument;
  }
  const double intervals = (coarse_range_m - range_m) / interval_m + 0.5;
  const std::int32_t k = floor_to_i32(intervals, 0, kManyTurns);
  return range_m + static_cast<double>(k) * interval_m;
}

}  // namespace picolo::inline v0
