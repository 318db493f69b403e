// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/witmotion_model.hpp"

#include <numbers>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0::sim {
namespace {

constexpr std::uint64_t kStream = 13;
constexpr double kFullScale = 32'768.0;
constexpr double kAccelerationRangeG = 16.0;
constexpr double kRateRangeRadps = 2000.0 * std::numbers::pi / 180.0;
constexpr std::int16_t kTemperature = 2500;  // 25 deg C
constexpr std::int16_t kVoltage = 500;       // 5 V
constexpr std::int16_t kFirmware = 0x2712;

/// Saturates at the ends of the sensor's range.
std::int16_t to_word(double value, double range) {
  return static_cast<std::int16_t>(round_to_i64(value / range * kFullScale, -32'768, 32'767));
}

}  // namespace

WitMotionModel::WitMotionModel(const WitMotionModelConfig& config, Timestamp start,
                               std::uint64_t seed)
    : config_(config), start_(start), random_(seed, kStream), next_(config.period) {
  for (double& bias : rate_bias_radps_) {
    bias = config_.rate_bias_sigma_radps * random_.gaussian();
  }
  for (double& bias : acceleration_bias_mps2_) {
    bias = config_.acceleration_bias_sigma_mps2 * random_.gaussian();
  }
}

void WitMotionModel::advance_to(Duration until, const Vehicle& vehicle, SerialLink& link) {
  for (; next_ <= until; next_ += config_.period) {
    const Result<VehicleState> state = vehicle.at(next_);
    const Timestamp stamp = start_ + next_;
    if (state && !link.suffers(FaultKind::freeze, stamp)) { measure(*state); }
    for (const WitMotionFrame& frame : frames_) { link.send(encode(frame), stamp); }
  }
}

void WitMotionModel::measure(const VehicleState& s) {
  const double omega = s.omega_radps;
  const Pose2d& mount = config_.base_T_imu;
  // Specific force at the sensor, in base axes: the base's own, plus the lever arm's.
  const double x_mps2 = s.acceleration_mps2 - omega * s.lateral_mps - s.alpha_radps2 * mount.y_m -
                        omega * omega * mount.x_m;
  const double y_mps2 =
      omega * s.speed_mps + s.alpha_radps2 * mount.x_m - omega * omega * mount.y_m;
  const SinCos<double> turn = sin_cos(mount.theta_rad);
  std::array<double, 3> force_mps2{turn.cosine * x_mps2 + turn.sine * y_mps2,
                                   -turn.sine * x_mps2 + turn.cosine * y_mps2,
                                   config_.gravity_mps2};
  std::array<double, 3> rate_radps{0.0, 0.0, omega};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    rate_bias_radps_[axis] += config_.rate_walk_sigma_radps * random_.gaussian();
    rate_radps[axis] += rate_bias_radps_[axis] + config_.rate_sigma_radps * random_.gaussian();
    force_mps2[axis] +=
        acceleration_bias_mps2_[axis] + config_.acceleration_sigma_mps2 * random_.gaussian();
    frames_[0].words[axis] = to_word(force_mps2[axis] / config_.gravity_mps2, kAccelerationRangeG);
    frames_[1].words[axis] = to_word(rate_radps[axis], kRateRangeRadps);
  }
  yaw_rad_ = wrap_angle(yaw_rad_ + rate_radps[2] * to_seconds_f64(config_.period));
  frames_[0].type = kWitMotionAcceleration;
  frames_[0].words[3] = kTemperature;
  frames_[1].type = kWitMotionRate;
  frames_[1].words[3] = kVoltage;
  frames_[2] = {.type = kWitMotionAngle,
                .words = {0, 0, to_word(yaw_rad_, std::numbers::pi), kFirmware}};
}

}  // namespace picolo::inline v0::sim
