// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How far dead reckoning may be off: what wanders, and what calibration left wrong.
#pragma once

#include "picolo/geometry/matrix3.hpp"
#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0 {

/// Standard deviations. What wanders grows with the root of the way; what is wrong once and for all
/// grows with the way or the time itself.
struct OdometryNoise {
  float walk_m = 0.01F;             ///< along the way, after 1 m
  float heading_walk_rad = 0.003F;  ///< after 1 m
  float walk_persists_m = 0.5F;  ///< of both: one slip lasts so long: shorter ways err as a whole
  float sideways_m = 0.003F;     ///< wheels that slip sideways in turns: after 1 rad
  float scale = 0.005F;          ///< of every distance
  float heading_per_m_rad = 0.001F;   ///< wheels of unequal radius
  float heading_per_s_rad = 0.0007F;  ///< the gyro's bias
  float heading_scale = 0.005F;       ///< of every turn
  [[nodiscard]] constexpr bool valid() const {
    return walk_m >= 0.0F && walk_persists_m >= 0.0F && heading_walk_rad >= 0.0F &&
           sideways_m >= 0.0F && scale >= 0.0F && heading_per_m_rad >= 0.0F &&
           heading_per_s_rad >= 0.0F && heading_scale >= 0.0F;
  }
};

/// A piece of way.
struct OdometryStep {
  float map_yaw_rad = 0.0F;  ///< of base at its beginning
  Pose2f motion{};           ///< in base at its beginning
  float elapsed_s = 0.0F;
};

/// Covariance of a pose that is carried along by odometry, in map axes. The constant errors are
/// considered, not estimated (Schmidt): the pose's sensitivity to each is kept. Context: cycle
/// only.
/// Cost: about 400 operations a call.
class MotionUncertainty {
 public:
  /// Nothing is owed to the way before.
  void start(const Matrix3f& covariance) {
    wandering_ = covariance;
    by_constant_ = {};
    way_m_ = 0.0F;
  }
  /// The pose moves on. `kept`: the part of the step's own error that stays in the pose, map axes.
  void add(const OdometryNoise& noise, const OdometryStep& step,
           const Matrix3f& kept = Matrix3f::identity());
  /// A measurement leaves `kept` of the error and brings its own.
  void correct(const Matrix3f& kept, const Matrix3f& measurement);
  [[nodiscard]] Matrix3f covariance() const;

 private:
  Matrix3f wandering_{};
  /// Columns: the pose's error for one sigma of the scale, of the heading's drift, of its scale.
  Matrix3f by_constant_{};
  float way_m_ = 0.0F;
};

}  // namespace picolo::inline v0
