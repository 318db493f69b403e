// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/pipeline.hpp"

#include <algorithm>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {
namespace {

constexpr Duration kCoastStep = 10ms;     // between poses, as wheels give them
constexpr float kStraight_radps = 0.2F;   // faster, errors of the gyro's scale look like bias
constexpr float kMostByBias_rad = 0.02F;  // from one match to the next

}  // namespace

HealthReason why_rejected(MatchOutcome outcome) {
  if (outcome == MatchOutcome::too_few_points) { return HealthReason::too_few_points; }
  if (outcome == MatchOutcome::out_of_map) { return HealthReason::out_of_map; }
  return HealthReason::match_rejected;
}

Pipeline::Pipeline(const ControllerConfig& config, const PipelineStorage& storage,
                   LocaliserCore& localiser, DriveModel* drive)
    : undistort_(config.undistort),
      max_bridge_(config.max_bridge),
      coast_(config.coast),
      max_lidar_age_(config.health.max_lidar_age),
      lidar_age_(config.lidar_age),
      localiser_(localiser),
      gyro_gain_(config.dead_reckoning.gyro_sign * config.dead_reckoning.gyro_scale),
      two_wheels_(config.drive),
      drive_(drive != nullptr ? *drive : two_wheels_),
      gate_(config.plausibility, drive_.encoder_scale()),
      plausibility_(config.plausibility),
      turn_check_(config.plausibility),
      wheel_check_(config.plausibility, drive_.encoder_scale()),
      gyro_check_(plausibility_),
      gravity_check_(plausibility_),
      dead_reckoning_(config.dead_reckoning),
      poses_(pose_storage_),
      sweeps_(config.sweeps, storage.first_sweep, storage.second_sweep),
      undistorter_(storage.x_m, storage.y_m),
      begins_apart_(config.work.one_stage_a_frame) {
  const float heading_rad = config.set_pose.start_heading_rad;
  localiser_.set_pose(config.start_map_T_base, Pose2d{},
                      Matrix3f::diagonal(0.0F, 0.0F, heading_rad * heading_rad));
}

void Pipeline::doubt(SensorIndex sensor, Timestamp stamp) {
  doubted_until_[static_cast<std::size_t>(sensor)] = stamp + plausibility_.doubt_hold;
}

/// Encoders of even index are on the left.
void Pipeline::doubt_wheels(std::uint8_t encoders, Timestamp stamp) {
  constexpr unsigned kLeft = 0b0101;
  constexpr unsigned kRight = 0b1010;
  if ((encoders & kLeft) != 0) { doubt(SensorIndex::left_wheel, stamp); }
  if ((encoders & kRight) != 0) { doubt(SensorIndex::right_wheel, stamp); }
}

SensorDoubts Pipeline::doubts() const {
  unsigned doubts = gravity_check_.doubtful() ? doubt_of(SensorIndex::accelerometer) : 0U;
  for (std::size_t i = 0; i < doubted_until_.size(); ++i) {
    if (newest_sample_ < doubted_until_[i]) { doubts |= 1U << i; }
  }
  return static_cast<SensorDoubts>(doubts);
}

void Pipeline::add(const ImuSample& sample) {
  newest_sample_ = std::max(newest_sample_, sample.stamp);
  if (gyro_check_.add(sample, moving_, turn_check_.difference_rad())) {
    doubt(SensorIndex::gyro, sample.stamp);
  }
  gravity_check_.add(sample, moving_);
  dead_reckoning_.hold_bias(gravity_check_.shaken());
  dead_reckoning_.add(sample);
  if (sample.saturated) { return; }
  turn_check_.add_gyro(sample.stamp,
                       gyro_gain_ * sample.rate_radps[2] - dead_reckoning_.gyro_bias_radps());
}

void Pipeline::add(RangeReading reading) {
  reading.stamp -= lidar_age_;
  const std::uint32_t completed = sweeps_.counters().completed;
  sweep_check_.add(reading);
  if (moving_ && sweep_check_.repeats()) { doubt(SensorIndex::lidar, newest_sample_); }
  sweeps_.add(reading);
  if (reading.ends_sweep) { last_reading_ = reading.stamp; }
  if (sweeps_.counters().completed != completed) { last_sweep_end_ = last_reading_; }
  last_reading_ = reading.stamp;
}

void Pipeline::add(WheelTicks ticks) {
  last_ticks_ = std::max(last_ticks_, ticks.stamp);
  if (coasting_) {
    // What the counters say of the time without them has been guessed already.
    if (ticks.stamp <= poses_.newest().stamp) { return; }
    ticks.restarted = true;
    coasting_ = false;
  }
  newest_sample_ = std::max(newest_sample_, ticks.stamp);
  const bool passed = gate_.pass(ticks);
  doubt_wheels(gate_.suspects(), ticks.stamp);
  if (!passed) {
    ++counters_.ticks_left_out;
    return;
  }
  doubt_wheels(wheel_check_.add(ticks), ticks.stamp);
  const Result<WheelIncrement> increment = drive_.update(ticks);
  if (increment.status() == Status::out_of_range) { ++counters_.ticks_refused; }
  if (increment.status() == Status::not_ready) { bridge(ticks.stamp); }
  if (!increment) { return; }
  moving_ = !increment->standing;
  dead_reckoning_.add(*increment);
  turn_check_.add(*increment);
  ++counters_.increments;
  (void)poses_.push(dead_reckoning_.pose());  // later than the last, or the increment would not be
}

void Pipeline::bridge(Timestamp to) {
  if (poses_.size() == 0) {
    (void)poses_.push({to, Pose2d{}});
    return;
  }
  const Timestamp from = poses_.newest().stamp;
  if (to <= from) { return; }
  // The counters started anew: what they would have told of the gap is lost. A short one was driven
  // as before; over a long one the place is kept, and the match has to find the rest. The turn is
  // the gyro's where there is one.
  WheelIncrement gap{.from = from, .to = to};
  if (to - from <= max_bridge_) {
    gap.from_T_to = exp_se2(dead_reckoning_.base_twist(), to - from);
  }
  dead_reckoning_.add(gap);
  (void)poses_.push(dead_reckoning_.pose());
  ++counters_.bridged;
}

void Pipeline::coast(Timestamp now) {
  const bool wheels = now - last_ticks_ <= coast_.after;
  const bool lidar = now - last_sweep_end_ <= max_lidar_age_;
  if (!coast_.enabled || wheels || !lidar) { return; }
  const Timestamp to = now - coast_.behind;
  if (poses_.size() == 0) {
    (void)poses_.push({to, Pose2d{}});
    return;
  }
  const Timestamp from = poses_.newest().stamp;
  if (to - from < kCoastStep) { return; }
  if (!coasting_) { coast_twist_ = dead_reckoning_.base_twist(); }
  coasting_ = true;
  guessed_ = true;
  if (!verdict_.accepted || now - verdict_.reference > coast_.max_age) { coast_twist_ = {}; }
  dead_reckoning_.add({.from = from, .to = to, .from_T_to = exp_se2(coast_twist_, to - from)});
  (void)poses_.push(dead_reckoning_.pose());
  ++counters_.coasted;
}

/// From the last match to the one that ends, where both tell the same way; else nothing.
Duration Pipeline::since_compared() const {
  const Duration since = localiser_.reference() - verdict_.reference;
  const bool compared = verdict_.accepted && localiser_.accepted() && !localiser_.relocalised() &&
                        since <= coast_.max_age;
  return compared ? std::max(since, Duration{0}) : Duration{0};
}

/// From this match and the last: no wheels are needed for it.
void Pipeline::learn_twist() {
  const Duration since = since_compared();
  if (since == Duration{0}) { return; }
  const double since_s = to_seconds_f64(since);
  const Tangent2<double> way = log_se2(between(verdict_.map_T_base, localiser_.map_T_base()));
  coast_twist_ = {static_cast<float>(way.x_m / since_s), static_cast<float>(way.y_m / since_s),
                  static_cast<float>(way.theta_rad / since_s)};
}

/// What matches turn further than the odometry, second by second, is the gyro's bias.
void Pipeline::learn_gyro_bias() {
  const Duration since = since_compared();
  const bool tells = since > Duration{0} && !localiser_.predicts_loosely() &&
                     localiser_.report().outcome != MatchOutcome::degenerate;
  if (!tells || !dead_reckoning_.turns_by_gyro() || doubts() != 0) { return; }
  const auto turned_rad = wrap_angle(static_cast<float>(
      undistorter_.result().odom_T_base.theta_rad - verdict_.odom_T_base.theta_rad));
  const auto further_rad = wrap_angle(
      static_cast<float>(localiser_.map_T_base().theta_rad - verdict_.map_T_base.theta_rad) -
      turned_rad);
  if (magnitude(turned_rad) > kStraight_radps * to_seconds(since) ||
      magnitude(further_rad) > kMostByBias_rad) {
    return;
  }
  dead_reckoning_.correct_bias(further_rad);
}

void Pipeline::take_sweep() {
  if (stage_ == PipelineStage::undistorting) { ++counters_.sweeps_replaced; }
  const Sweep sweep = sweeps_.take();
  ++counters_.sweeps_taken;
  stage_ = PipelineStage::undistorting;
  if (!is_ok(undistorter_.begin(undistort_, sweep))) {
    ++counters_.sweeps_refused;
    stage_ = PipelineStage::waiting;
  }
}

bool Pipeline::undistort(std::size_t max_returns) {
  const bool may_take = stage_ == PipelineStage::waiting || stage_ == PipelineStage::undistorting;
  if (may_take && !undistorted_ && !paused_ && sweeps_.ready()) { take_sweep(); }
  if (stage_ != PipelineStage::undistorting) { return false; }
  const Status status = undistorted_ ? Status::ok : undistorter_.step(poses_, max_returns);
  if (status == Status::not_ready) { return false; }
  if (status == Status::ok && begins_apart_ && !undistorted_) {
    undistorted_ = true;
    return false;
  }
  undistorted_ = false;
  stage_ = PipelineStage::waiting;
  if (status != Status::ok) {
    ++counters_.sweeps_uncovered;
    return false;
  }
  if (pose_was_set_) {
    const Pose2d odom_T_base = newest_pose({}).odom_T_base;
    localiser_.set_pose(set_map_T_odom_ * odom_T_base, odom_T_base, set_covariance_);
    pose_was_set_ = false;
  }
  localiser_.predict_loosely(guessed_);
  guessed_ = coasting_;
  constexpr bool kOdometryValid = true;  // without poses the sweep would not have been undistorted
  if (!is_ok(localiser_.begin(undistorter_.result(), kOdometryValid))) {
    ++counters_.sweeps_refused;
    return false;
  }
  stage_ = PipelineStage::matching;
  return true;
}

bool Pipeline::match(std::size_t max_point_iterations) {
  if (stage_ != PipelineStage::matching) { return false; }
  const std::size_t points = std::max<std::size_t>(1, undistorter_.result().points.size());
  const std::size_t iterations = std::max<std::size_t>(1, max_point_iterations / points);
  for (std::size_t i = 0; i < iterations && !localiser_.searching(); ++i) {
    if (localiser_.match_step()) { return conclude(); }
  }
  return false;
}

bool Pipeline::search(std::size_t max_slices) {
  if (stage_ != PipelineStage::matching) { return false; }
  for (std::size_t i = 0; i < max_slices && localiser_.searching(); ++i) {
    if (localiser_.match_step()) { return conclude(); }
  }
  return false;
}

bool Pipeline::conclude() {
  const MatchReport& report = localiser_.report();
  learn_twist();
  learn_gyro_bias();
  verdict_.guessed = localiser_.predicts_loosely();
  verdict_.relocalised = localiser_.relocalised();
  verdict_.accepted = localiser_.accepted();
  verdict_.direction_unobservable = report.outcome == MatchOutcome::degenerate;
  verdict_.turned_by_gyro = dead_reckoning_.turns_by_gyro();
  verdict_.rejection = verdict_.accepted ? HealthReason::none : why_rejected(report.outcome);
  verdict_.reference = localiser_.reference();
  verdict_.odom_T_base = undistorter_.result().odom_T_base;
  verdict_.map_T_base = localiser_.map_T_base();
  verdict_.covariance = localiser_.match_covariance();
  verdict_.drift_covariance = localiser_.drift_covariance();
  verdict_.agreement = localiser_.agreement();
  verdict_.inlier_share = localiser_.counters().sweeps == 1 ? 1.0F : report.inlier_share;
  stage_ = localiser_.phase() == LocaliserPhase::mapping ? PipelineStage::mapping
                                                         : PipelineStage::waiting;
  return !pose_was_set_;
}

void Pipeline::map(std::size_t max_rays) {
  if (stage_ == PipelineStage::mapping && localiser_.map_step(max_rays)) {
    stage_ = PipelineStage::waiting;
  }
}

}  // namespace picolo::inline v0
