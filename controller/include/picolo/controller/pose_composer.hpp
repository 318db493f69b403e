// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The published pose: map_T_odom * odom_T_base(now), with what is known of its error.
#pragma once

#include "picolo/controller/controller_config.hpp"
#include "picolo/controller/pipeline.hpp"
#include "picolo/core/time.hpp"
#include "picolo/localisation/pose_estimate.hpp"
#include "picolo/odometry/motion_uncertainty.hpp"
#include "picolo/odometry/wheel_odometry.hpp"

namespace picolo::inline v0 {

/// What an accepted match did to the published pose, by MatchTrust's limits.
struct PoseCorrection {
  bool jumped = false;  ///< it moved or turned by more than configured
  bool pulled = false;  ///< the last ones went the same way for so long that the sensors disagree
  bool leapt = false;   ///< it moved or turned further than an error of the odometry explains
};

/// A finished match for an instant in the past corrects map_T_odom only; odometry since then is
/// kept. Context: cycle only.
class PoseComposer {
 public:
  /// Precondition: config.valid().
  explicit PoseComposer(const ControllerConfig& config);

  /// The ages of an estimate without any match count from here.
  void start(Timestamp now) {
    reference_ = now;
    last_odometry_.stamp = now;
  }
  /// An accepted match. `odometry`: the newest pose.
  void correct(const MatchVerdict& verdict, const StampedPose& odometry);
  /// Somebody who knows says where the vehicle is; `odometry`: the newest pose.
  void set_pose(const Pose2d& map_T_base, const StampedPose& odometry);
  /// The estimate for `now`: odometry carried on with its last twist, for at most max_prediction;
  /// the stamp says how far. State and reason are the caller's to fill in. Cost: five sin_cos.
  [[nodiscard]] PoseEstimate compose(Timestamp now, const StampedPose& odometry,
                                     const Twist2& base_twist);

  /// Of a pose that a command sets, map axes.
  [[nodiscard]] Matrix3f set_pose_covariance() const;
  [[nodiscard]] const Pose2d& map_T_odom() const { return map_T_odom_; }
  /// What the last match did.
  [[nodiscard]] PoseCorrection correction() const;
  /// The wheels alone have turned the vehicle further since the last match than they are trusted.
  [[nodiscard]] bool turn_unverified(bool turned_by_gyro) const {
    return !turned_by_gyro && turned_since_match_rad_ > trust_.max_wheel_turn_rad;
  }
  /// How far the last correction went, in millimetres.
  [[nodiscard]] std::int32_t jump_mm() const;

 private:
  [[nodiscard]] float turn_factor() const;
  [[nodiscard]] float wheel_turn(const OdometryStep& step) const;
  void travel(const StampedPose& odometry);
  [[nodiscard]] OdometryStep step_between(const StampedPose& from, const StampedPose& to) const;

  OdometryNoise odometry_noise_;
  SetPoseSigma set_pose_sigma_;
  Duration max_prediction_;
  MatchTrust trust_;
  Pose2d map_T_odom_{};
  Timestamp reference_{};
  Pose2d reference_odom_T_base_{};
  Pose2d reference_map_T_base_{};
  Matrix3f drift_covariance_{};  // at the reference
  StampedPose last_odometry_{};
  MotionUncertainty since_match_{};
  float turned_since_match_rad_ = 0.0F;
  Pose2f last_jump_{};
  Pose2f pull_{};  // sum of jumps, fading; theta is a sum, not wrapped
  std::uint32_t matches_ = 0;
  bool turned_by_gyro_ = true;
};

}  // namespace picolo::inline v0
