// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the odometry's heading gets systematically wrong, learnt while driving.
#pragma once

#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0 {

struct HeadingCorrectionConfig {
  double scale_sigma = 0.05;      ///< prior belief about a
  double per_m_sigma_rad = 0.05;  ///< prior belief about b
  double scale_walk = 1e-3;       ///< how far a wanders in one update
  double per_m_walk_rad = 1e-3;   ///< how far b wanders in one update
  double gate_sigma = 3.0;        ///< a measurement further off teaches nothing
  [[nodiscard]] constexpr bool valid() const {
    return scale_sigma >= 0.0 && per_m_sigma_rad >= 0.0 && scale_walk >= 0.0 &&
           per_m_walk_rad >= 0.0 && gate_sigma > 0.0;
  }
};

/// Kalman filter of two states: true turn = (1 + a) * odometry's turn + b * distance. a is a wrong
/// track width, b wheels of unequal radius. Fed by accepted matches, used by the prediction only:
/// odom_T_base itself stays what the sensors said.
/// Cost: about 40 operations in double an update. Context: cycle only.
class HeadingCorrection {
 public:
  explicit HeadingCorrection(const HeadingCorrectionConfig& config = {});

  /// The motion with its turn corrected; arc length and side slip are kept.
  [[nodiscard]] Pose2d corrected(const Pose2d& odometry_motion) const;
  /// Variance that the uncertainty of a and b adds to the turn of this motion (rad^2).
  [[nodiscard]] double variance(const Pose2d& odometry_motion) const;
  /// `measured_turn_rad` as the match found it, with its variance (rad^2), odometry noise included.
  void update(const Pose2d& odometry_motion, double measured_turn_rad, double variance_rad2);

  [[nodiscard]] double scale() const { return a_; }
  [[nodiscard]] double per_m_rad() const { return b_; }

 private:
  HeadingCorrectionConfig config_;
  double a_ = 0.0;
  double b_ = 0.0;
  double p_aa_;
  double p_ab_ = 0.0;
  double p_bb_;
};

}  // namespace picolo::inline v0
