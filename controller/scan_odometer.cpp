// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/scan_odometer.hpp"

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

PointsView ScanOdometerCore::view(std::size_t index) const {
  const std::size_t size = scans_[index].size;
  return {storage_.x_m[index].first(size), storage_.y_m[index].first(size)};
}

void ScanOdometerCore::keep(const PointsView& points, Scan& scan, std::size_t index,
                            const Pose2d& base_T_lidar) {
  const Pose2f lidar_T_base = to_f32(inverse(base_T_lidar));
  const SinCos<float> turn = sin_cos(lidar_T_base.theta_rad);
  scan.size = std::min(points.size(), storage_.x_m[index].size());
  for (std::size_t k = 0; k < scan.size; ++k) {
    const std::size_t from = k * points.size() / scan.size;
    const float x = points.x_m[from];
    const float y = points.y_m[from];
    storage_.x_m[index][k] = turn.cosine * x - turn.sine * y + lidar_T_base.x_m;
    storage_.y_m[index][k] = turn.sine * x + turn.cosine * y + lidar_T_base.y_m;
  }
}

void ScanOdometerCore::offer(const PointsView& points, Timestamp stamp, const Pose2d& odom_T_base,
                             const Pose2d& base_T_lidar) {
  const Duration since = stamp - scans_[reference_].stamp;
  const bool busy = stage_ == Stage::begin || stage_ == Stage::iterate;
  if (busy || (stage_ == Stage::reference && since < config_.min_interval)) {
    ++counters_.skipped;
    return;
  }
  const bool first = stage_ == Stage::empty || since > config_.max_interval;
  const std::size_t index = first ? reference_ : 1 - reference_;
  scans_[index].stamp = stamp;
  scans_[index].odom_T_lidar = odom_T_base * base_T_lidar;
  keep(points, scans_[index], index, base_T_lidar);
  stage_ = first ? Stage::reference : Stage::begin;
}

bool ScanOdometerCore::step() {
  if (stage_ == Stage::begin) {
    const Pose2d guess =
        between(scans_[reference_].odom_T_lidar, scans_[1 - reference_].odom_T_lidar);
    matcher_.begin_slices(view(reference_),
                          {.points = view(1 - reference_), .start = to_f32(guess)});
    stage_ = Stage::iterate;
    return true;
  }
  if (stage_ != Stage::iterate) { return false; }
  if (matcher_.step_slice(config_.max_looks)) { conclude(); }
  return true;
}

void ScanOdometerCore::conclude() {
  const MatchReport& report = matcher_.report();
  if (report.outcome == MatchOutcome::converged) {
    ++counters_.matched;
    result_ = {scans_[reference_].stamp, scans_[1 - reference_].stamp, to_f64(report.pose)};
    fresh_ = true;
  } else {
    ++counters_.failed;
  }
  reference_ = 1 - reference_;
  stage_ = Stage::reference;
}

bool ScanOdometerCore::take(ScanDisplacement& displacement) {
  if (!fresh_) { return false; }
  displacement = result_;
  fresh_ = false;
  return true;
}

void ScanOdometerCore::reset() {
  stage_ = Stage::empty;
  fresh_ = false;
}

}  // namespace picolo::inline v0
