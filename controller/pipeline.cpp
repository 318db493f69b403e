// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/pipeline.hpp"

#include <algorithm>

namespace picolo::inline v0 {
namespace {

HealthReason why_rejected(MatchOutcome outcome) {
  if (outcome == MatchOutcome::too_few_points) { return HealthReason::too_few_points; }
  if (outcome == MatchOutcome::out_of_map) { return HealthReason::out_of_map; }
  return HealthReason::match_rejected;
}

}  // namespace

Pipeline::Pipeline(const ControllerConfig& config, const PipelineStorage& storage,
                   LocaliserCore& localiser)
    : undistort_(config.undistort),
      localiser_(localiser),
      drive_(config.drive),
      dead_reckoning_(config.dead_reckoning),
      poses_(pose_storage_),
      sweeps_(config.sweeps, storage.first_sweep, storage.second_sweep),
      undistorter_(storage.x_m, storage.y_m) {
  localiser_.set_pose(config.start_map_T_base, Pose2d{});
}

void Pipeline::add(const WheelTicks& ticks) {
  const Result<WheelIncrement> increment = drive_.update(ticks);
  if (increment.status() == Status::out_of_range) { ++counters_.ticks_refused; }
  if (increment.status() == Status::not_ready) {
    // The first sample, or counters that started anew: nothing is known of the way to here, so the
    // pose is taken to have stood.
    (void)poses_.push({ticks.stamp, dead_reckoning_.pose().odom_T_base});
  }
  if (!increment) { return; }
  dead_reckoning_.add(*increment);
  ++counters_.increments;
  (void)poses_.push(dead_reckoning_.pose());  // later than the last, or the increment would not be
}

void Pipeline::take_sweep() {
  if (stage_ == PipelineStage::undistorting) { ++counters_.sweeps_replaced; }
  const Sweep sweep = sweeps_.take();
  last_sweep_end_ = sweep.last_stamp;
  ++counters_.sweeps_taken;
  stage_ = PipelineStage::undistorting;
  if (!is_ok(undistorter_.begin(undistort_, sweep))) {
    ++counters_.sweeps_refused;
    stage_ = PipelineStage::waiting;
  }
}

void Pipeline::undistort(std::size_t max_returns) {
  const bool may_take = stage_ == PipelineStage::waiting || stage_ == PipelineStage::undistorting;
  if (may_take && sweeps_.ready()) { take_sweep(); }
  if (stage_ != PipelineStage::undistorting) { return; }
  const Status status = undistorter_.step(poses_, max_returns);
  if (status == Status::not_ready) { return; }
  stage_ = PipelineStage::waiting;
  if (status != Status::ok) {
    ++counters_.sweeps_uncovered;
    return;
  }
  constexpr bool kOdometryValid = true;  // without poses the sweep would not have been undistorted
  if (!is_ok(localiser_.begin(undistorter_.result(), kOdometryValid))) {
    ++counters_.sweeps_refused;
    return;
  }
  stage_ = PipelineStage::matching;
}

bool Pipeline::match(std::size_t max_point_iterations) {
  if (stage_ != PipelineStage::matching) { return false; }
  const std::size_t points = std::max<std::size_t>(1, undistorter_.result().points.size());
  const std::size_t iterations = std::max<std::size_t>(1, max_point_iterations / points);
  for (std::size_t i = 0; i < iterations; ++i) {
    if (localiser_.match_step()) {
      conclude();
      return true;
    }
  }
  return false;
}

void Pipeline::conclude() {
  const MatchReport& report = localiser_.report();
  verdict_.accepted = localiser_.accepted();
  verdict_.direction_unobservable = report.outcome == MatchOutcome::degenerate;
  verdict_.rejection = verdict_.accepted ? HealthReason::none : why_rejected(report.outcome);
  verdict_.reference = localiser_.reference();
  verdict_.odom_T_base = undistorter_.result().odom_T_base;
  verdict_.map_T_base = localiser_.map_T_base();
  verdict_.covariance = report.covariance;
  stage_ = localiser_.phase() == LocaliserPhase::mapping ? PipelineStage::mapping
                                                         : PipelineStage::waiting;
}

void Pipeline::map(std::size_t max_rays) {
  if (stage_ == PipelineStage::mapping && localiser_.map_step(max_rays)) {
    stage_ = PipelineStage::waiting;
  }
}

}  // namespace picolo::inline v0
