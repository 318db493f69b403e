// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A driven and a steered axle: cars, tricycles, forklifts with a steered driving wheel.
#pragma once

#include "picolo/odometry/wheel_odometry.hpp"

namespace picolo::inline v0 {

/// Where the path is measured: at the middle of the fixed axle, or at the steered wheel itself.
enum class DrivenAxle : std::uint8_t { fixed, steered };

/// Base is the middle of the fixed axle, x towards the steered one (`wheelbase_m` may be negative
/// for vehicles steered at the rear). Ticks: 0 the path, positive forward; 1 the steering's
/// position, positive to the left. Two steered wheels are seen as the one in their middle: the
/// linkage's table belongs into the driver of the steering encoder.
struct AckermannDriveConfig {
  double wheel_radius_m = 0.15;
  double wheelbase_m = 1.0;
  double counts_per_revolution = 4096.0;       ///< of the wheel, gear included
  double steering_counts_per_turn = 36'000.0;  ///< of the steering, 2 pi
  double steering_zero_counts = 0.0;           ///< where it drives straight on
  double max_steering_rad = 1.3;  ///< beyond it no motion; < 1.55 for `fixed`, path * tan(steering)
  DrivenAxle driven = DrivenAxle::fixed;
  [[nodiscard]] constexpr bool valid() const {
    const bool steers = driven == DrivenAxle::steered || max_steering_rad < 1.55;
    return wheel_radius_m > 0.0 && wheelbase_m != 0.0 && counts_per_revolution > 0.0 &&
           steering_counts_per_turn > 0.0 && max_steering_rad > 0.0 && steers;
  }
};
static_assert(AckermannDriveConfig{}.valid());

/// The bicycle model: turn = path * tan(steering) / wheelbase at the fixed axle; path *
/// sin(steering) / wheelbase, and forward path * cos(steering), at the steered wheel. The steering
/// between two samples is taken as their mean: exact when it rests, of second order when it moves.
/// `out_of_range` also for a steering beyond its limit (that sample is a base for the next). Cost:
/// two sin_cos in double. Context: cycle only.
class AckermannDrive {
 public:
  explicit AckermannDrive(const AckermannDriveConfig& config = {}) : config_(config) {}

  Result<WheelIncrement> update(const WheelTicks& ticks);
  /// Column 1: of the steering at the newer sample (that of the older one is the same).
  [[nodiscard]] WheelJacobian jacobian() const;
  [[nodiscard]] EncoderScale encoder_scale() const;
  [[nodiscard]] const AckermannDriveConfig& config() const { return config_; }

 private:
  /// The path for each metre that the wheel rolled, and how it changes with the steering.
  struct Steered {
    Tangent2<double> per_m{};
    Tangent2<double> per_m_rad{};
  };
  [[nodiscard]] Steered steered(double steering_rad) const;

  AckermannDriveConfig config_;
  double path_m_ = 0.0;  // of the last increment
  double steering_rad_ = 0.0;
  WheelTicks last_{};
  bool has_last_ = false;
};

}  // namespace picolo::inline v0
