// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How a laser measures distance: time of flight and phase shift. In double, since a millimetre of
/// range is 7 ps of time. Context: any. Cost: O(1).
#pragma once

#include "picolo/core/result.hpp"

namespace picolo::inline v0 {

inline constexpr double kSpeedOfLight_mps = 299792458.0;   ///< in vacuum, exact
inline constexpr double kRefractiveIndexOfAir = 1.000273;  ///< 15 deg C, 1013 hPa, near infrared

/// r = c dt / (2 n). `invalid_argument`: dt < 0 or not finite, n < 1.
[[nodiscard]] Result<double> time_of_flight_range_m(
    double round_trip_s, double refractive_index = kRefractiveIndexOfAir);

/// A modulated beam repeats itself: ranges that differ by a multiple of c / (2 n f) look alike.
/// `invalid_argument`: f <= 0 or not finite, n < 1.
[[nodiscard]] Result<double> ambiguity_interval_m(double modulation_hz,
                                                  double refractive_index = kRefractiveIndexOfAir);

/// The time that the phase difference of a modulated beam stands for: dt = dphi / (2 pi f).
/// `invalid_argument`: f <= 0 or anything not finite.
[[nodiscard]] Result<double> phase_shift_time_s(double phase_rad, double modulation_hz);

/// The range in [0, ambiguity interval) that a phase difference stands for; any multiple of the
/// interval may have to be added. The phase may be given in any turn.
[[nodiscard]] Result<double> phase_shift_range_m(double phase_rad, double modulation_hz,
                                                 double refractive_index = kRefractiveIndexOfAir);

/// The candidate r + k * interval, k >= 0, next to a coarse range (of a lower modulation frequency,
/// or of time of flight). The coarse range must be good to half an interval. `invalid_argument`:
/// interval <= 0, or anything negative or not finite.
[[nodiscard]] Result<double> resolve_ambiguity_m(double range_m, double interval_m,
                                                 double coarse_range_m);

}  // namespace picolo::inline v0
