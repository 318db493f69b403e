// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The wheel model from positions that something outside of the vehicle saw, e.g. a camera above
/// it. Several passes over re-readable sources, no memory of samples.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/calibration/parameter.hpp"
#include "picolo/calibration/samples.hpp"
#include "picolo/calibration/time_offset.hpp"
#include "picolo/calibration/wheel_model.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// Where the marker of the vehicle was seen.
struct TrackPosition {
  double stamp_s = 0.0;  ///< on the wheels' clock
  double x_m = 0.0;
  double y_m = 0.0;
};

struct TrackBatchConfig {
  double radius_m = 0.1;  ///< of both wheels; where the search begins
  double track_m = 0.5;
  int max_iterations = 40;
  int headings = 12;  ///< of the start that are tried
  std::uint64_t min_positions = 20;
  double max_relative_std = 0.05;  ///< of radii and track width; above: refused
  [[nodiscard]] constexpr bool valid() const {
    return radius_m > 0.0 && track_m > 0.0 && max_iterations > 0 && headings > 0 &&
           min_positions >= 8 && max_relative_std > 0.0;
  }
};

struct TrackReport {
  Estimate radius_left_m{};
  Estimate radius_right_m{};
  Estimate track_m{};
  Pose2d start{};           ///< of base, in the tracker's frame, at the first wheel sample
  double marker_x_m = 0.0;  ///< in base
  double marker_y_m = 0.0;
  double rms_before_m = 0.0;  ///< with the given radius and track, and the best start
  double rms_after_m = 0.0;
  std::uint64_t positions = 0;
  Refusal refusal{};
};

/// Dead reckoning over the whole recording against the positions: Levenberg-Marquardt over radii,
/// track width, start and marker, derivatives carried along the path. Status as calibrate_joint.
/// Cost: a pass an iteration and heading. State: under 2 KiB.
Status calibrate_track(SampleSource<WheelAngles>& wheels, SampleSource<TrackPosition>& positions,
                       const TrackBatchConfig& config, TrackReport& report);

/// Root mean square distance of dead reckoning with the report's parameters to other positions.
[[nodiscard]] double track_rms_m(SampleSource<WheelAngles>& wheels,
                                 SampleSource<TrackPosition>& positions, const TrackReport& report);

}  // namespace picolo::inline v0
