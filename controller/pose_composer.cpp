// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/pose_composer.hpp"

#include <algorithm>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
PoseComposer::PoseComposer(const ControllerConfig& config)
    : odometry_noise_(config.localiser.uncertainty.odometry),
      set_pose_sigma_(config.set_pose),
      max_prediction_(config.max_prediction),
      trust_(config.trust),
      map_T_odom_(config.start_map_T_base),
      reference_map_T_base_(config.start_map_T_base) {
  since_match_.start(Matrix3f::diagonal(0.0F, 0.0F, square(set_pose_sigma_.start_heading_rad)));
}

void PoseComposer::travel(const StampedPose& odometry) {
  const OdometryStep step = step_between(last_odometry_, odometry);
  last_odometry_ = odometry;
  turned_since_match_rad_ += wheel_turn(step);
  if (step.motion != Pose2f{}) { since_match_.add(odometry_noise_, step); }
}

/// At most, whatever one of the wheels counts wrongly.
float PoseComposer::wheel_turn(const OdometryStep& step) const {
  const float way_m = hypotenuse(step.motion.x_m, step.motion.y_m);
  return magnitude(step.motion.theta_rad) + trust_.hidden_turn_per_m * way_m;
}

OdometryStep PoseComposer::step_between(const StampedPose& from, const StampedPose& to) const {
  return {.map_yaw_rad = static_cast<float>(map_T_odom_.theta_rad + from.odom_T_base.theta_rad),
          .motion = to_f32(between(from.odom_T_base, to.odom_T_base)),
          .elapsed_s = static_cast<float>(to_seconds_f64(to.stamp - from.stamp))};
}

void PoseComposer::correct(const MatchVerdict& verdict, const StampedPose& odometry) {
  const Pose2d corrected = verdict.map_T_base * inverse(verdict.odom_T_base);
  const Pose2d& odom_T_base = odometry.odom_T_base;
  last_jump_ = to_f32(between(map_T_odom_ * odom_T_base, corrected * odom_T_base));
  turned_by_gyro_ = verdict.turned_by_gyro;
  const bool compared = !verdict.guessed && !verdict.relocalised;
  pull_ = !compared ? Pose2f{}
                    : Pose2f{trust_.pull_kept * pull_.x_m + last_jump_.x_m,
                             trust_.pull_kept * pull_.y_m + last_jump_.y_m,
                             trust_.pull_kept * pull_.theta_rad + last_jump_.theta_rad};
  map_T_odom_ = corrected;
  reference_ = verdict.reference;
  reference_odom_T_base_ = verdict.odom_T_base;
  reference_map_T_base_ = verdict.map_T_base;
  drift_covariance_ = verdict.drift_covariance;
  // Fractions of a second have passed since the reference: the chord stands for the way.
  since_match_.start(verdict.covariance);
  const OdometryStep since = step_between({verdict.reference, verdict.odom_T_base}, odometry);
  since_match_.add(odometry_noise_, since);
  turned_since_match_rad_ = wheel_turn(since);
  last_odometry_ = odometry;
  ++matches_;
}

void PoseComposer::set_pose(const Pose2d& map_T_base, const StampedPose& odometry) {
  map_T_odom_ = map_T_base * inverse(odometry.odom_T_base);
  reference_ = odometry.stamp;
  reference_odom_T_base_ = odometry.odom_T_base;
  reference_map_T_base_ = map_T_base;
  since_match_.start(set_pose_covariance());
  turned_since_match_rad_ = 0.0F;
  last_odometry_ = odometry;
  last_jump_ = {};
  pull_ = {};
}

PoseEstimate PoseComposer::compose(Timestamp now, const StampedPose& odometry,
                                   const Twist2& base_twist) {
  travel(odometry);
  const Duration ahead = std::clamp(Duration{now - odometry.stamp}, Duration{0}, max_prediction_);
  PoseEstimate estimate;
  estimate.stamp = odometry.stamp + ahead;
  estimate.odom_T_base = odometry.odom_T_base * exp_se2(base_twist, ahead);
  estimate.map_T_base = map_T_odom_ * estimate.odom_T_base;
  estimate.base_twist = base_twist;
  estimate.last_jump = last_jump_;
  estimate.match_age = estimate.stamp - reference_;
  estimate.matches = matches_;

  estimate.match_covariance = since_match_.covariance();
  const Pose2f at_match{0.0F, 0.0F, static_cast<float>(reference_map_T_base_.theta_rad)};
  const Pose2f moved = to_f32(between(reference_odom_T_base_, estimate.odom_T_base));
  estimate.drift_covariance = propagate(compose_jacobian_left(at_match, moved), drift_covariance_);
  return estimate;
}

Matrix3f PoseComposer::set_pose_covariance() const {
  const float position_m2 = square(set_pose_sigma_.position_m);
  return Matrix3f::diagonal(position_m2, position_m2, square(set_pose_sigma_.heading_rad));
}

PoseCorrection PoseComposer::correction() const {
  const auto beyond = [](const Pose2f& way, float limit_m, float limit_rad) {
    return hypotenuse(way.x_m, way.y_m) > limit_m || magnitude(way.theta_rad) > limit_rad;
  };
  return {.jumped = beyond(last_jump_, trust_.max_correction_m,
                           turn_factor() * trust_.max_correction_rad),
          .pulled = beyond(pull_, trust_.max_pull_m, turn_factor() * trust_.max_pull_rad),
          .leapt = beyond(last_jump_, trust_.max_leap_m, trust_.max_leap_rad)};
}

float PoseComposer::turn_factor() const {
  return turned_by_gyro_ ? 1.0F : trust_.without_gyro;
}

std::int32_t PoseComposer::jump_mm() const {
  return round_to_i32(hypotenuse(last_jump_.x_m, last_jump_.y_m) * 1000.0F, 0, 1'000'000'000);
}

}  // namespace picolo::inline v0
