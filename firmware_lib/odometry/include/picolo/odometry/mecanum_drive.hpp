// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Four mecanum wheels: moves in every direction.
#pragma once

#include "picolo/odometry/wheel_odometry.hpp"

namespace picolo::inline v0 {

/// Base is the middle of the four contact points, x forward. Rollers seen from above form an X:
/// those of front left and rear right point from outside front to inside rear. Ticks: 0 front left,
/// 1 front right, 2 rear left, 3 rear right; positive rolls forward.
struct MecanumDriveConfig {
  std::array<double, kMaxWheels> radius_m{0.05, 0.05, 0.05, 0.05};
  double track_m = 0.4;                   ///< left to right contact points
  double wheelbase_m = 0.4;               ///< front to rear
  double counts_per_revolution = 4096.0;  ///< of a wheel, gear included
  [[nodiscard]] constexpr bool valid() const {
    for (const double radius : radius_m) {
      if (!(radius > 0.0)) { return false; }
    }
    return track_m > 0.0 && wheelbase_m > 0.0 && counts_per_revolution > 0.0;
  }
};
static_assert(MecanumDriveConfig{}.valid());

/// Exact for constant wheel speeds between samples. Four wheels tell three motions; what they say
/// beyond is slip: `slip_m` is the path by which the diagonals disagree in the last increment.
/// Cost: one sin_cos in double. Context: cycle only. Taheri, Qiao, Ghaeminezhad 2015, "Kinematic
/// model of a four mecanum wheeled mobile robot".
class MecanumDrive {
 public:
  explicit MecanumDrive(const MecanumDriveConfig& config = {}) : config_(config) {}

  Result<WheelIncrement> update(const WheelTicks& ticks);
  [[nodiscard]] WheelJacobian jacobian() const;
  [[nodiscard]] EncoderScale encoder_scale() const;
  [[nodiscard]] double slip_m() const { return slip_m_; }
  [[nodiscard]] const MecanumDriveConfig& config() const { return config_; }

 private:
  MecanumDriveConfig config_;
  Tangent2<double> path_{};  // of the last increment
  double slip_m_ = 0.0;
  WheelTicks last_{};
  bool has_last_ = false;
};

}  // namespace picolo::inline v0
