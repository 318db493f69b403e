// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A WitMotion IMU on the vehicle: bias, noise, quantisation, and the three frames that it sends.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/random.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/sim/links.hpp"
#include "picolo/sim/vehicle.hpp"
#include "picolo/sim/witmotion_wire.hpp"

namespace picolo::inline v0::sim {

struct WitMotionModelConfig {
  Pose2d base_T_imu{};  ///< true mounting; z up
  Duration period = 10ms;
  std::uint32_t baud = 115'200;
  double gravity_mps2 = 9.80665;
  double rate_sigma_radps = 0.003;         ///< white, each sample
  double rate_bias_sigma_radps = 0.005;    ///< drawn once an axis
  double rate_walk_sigma_radps = 0.00002;  ///< added to the bias at each sample
  double acceleration_sigma_mps2 = 0.05;
  double acceleration_bias_sigma_mps2 = 0.05;
  [[nodiscard]] constexpr bool valid() const { return period > Duration{0} && baud > 0; }
};

/// Measures at multiples of the period and sends at once: 0x51, 0x52, 0x53, back to back.
class WitMotionModel {
 public:
  WitMotionModel(const WitMotionModelConfig& config, Timestamp start, std::uint64_t seed);

  /// Measures and sends everything due up to `until`. Precondition: the vehicle has reached
  /// `until`.
  void advance_to(Duration until, const Vehicle& vehicle, SerialLink& link);
  /// The biases as they are now: the truth that an estimator is judged by. Order x y z.
  [[nodiscard]] const std::array<double, 3>& rate_bias_radps() const { return rate_bias_radps_; }
  [[nodiscard]] const std::array<double, 3>& acceleration_bias_mps2() const {
    return acceleration_bias_mps2_;
  }

 private:
  void measure(const VehicleState& state);

  WitMotionModelConfig config_;
  Timestamp start_;
  Random random_;
  Duration next_{};
  double yaw_rad_ = 0.0;
  std::array<double, 3> rate_bias_radps_{};
  std::array<double, 3> acceleration_bias_mps2_{};
  std::array<WitMotionFrame, 3> frames_{};
};

}  // namespace picolo::inline v0::sim
