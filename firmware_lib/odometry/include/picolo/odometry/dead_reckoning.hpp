// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Wheels for the distance, gyro for the turn: continuous odom_T_base.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/status.hpp"
#include "picolo/odometry/wheel_odometry.hpp"
#include "picolo/sensing/imu_sample.hpp"
#include "picolo/undistort/pose_buffer.hpp"

namespace picolo::inline v0 {

struct DeadReckoningConfig {
  bool use_gyro = true;
  float gyro_sign = 1.0F;   ///< -1 for a sensor mounted upside down
  float gyro_scale = 1.0F;  ///< true rate over measured rate, see GyroCalibration
  /// The last rate holds for at most this long; beyond it the wheels turn alone.
  Duration gyro_hold = 25ms;
  Duration standstill = 400ms;  ///< wheels without a count for this long: the gyro shows its bias
  /// A larger rate at standstill is no bias (somebody pushes the vehicle).
  float max_bias_radps = 0.15F;
  int bias_samples = 200;  ///< averaging length of the bias
  /// At standstill samples are averaged over blocks of this length, and a block counts only when
  /// the wheels stood during the whole next one: a coarse encoder counts late after a start.
  Duration standstill_block = 100ms;
  /// Headings of matches draw the bias towards theirs with this time constant.
  Duration bias_follows = 10s;
  [[nodiscard]] constexpr bool valid() const {
    return gyro_hold >= Duration{0} && standstill > Duration{0} && max_bias_radps > 0.0F &&
           bias_samples > 0 && standstill_block > Duration{0} && bias_follows > Duration{0} &&
           gyro_scale > 0.0F && (gyro_sign == 1.0F || gyro_sign == -1.0F);
  }
};

struct DeadReckoningCounters {
  std::uint32_t increments = 0;
  std::uint32_t with_gyro = 0;      ///< of these, how many took their turn from the gyro
  std::uint32_t gyro_rejected = 0;  ///< samples that were saturated or not newer
};

/// The turn of each wheel increment is replaced by the gyro's where the gyro covers both its ends;
/// the integrated gyro angle is remembered at the end that was used, so that a late sample corrects
/// the next increment instead of being lost. Cost: O(1). Context: cycle only.
class DeadReckoning {
 public:
  explicit DeadReckoning(const DeadReckoningConfig& config = {});

  void add(const ImuSample& sample);
  /// While held, nothing is learnt of the gyro's bias: wheels stand, yet something moves the
  /// vehicle.
  void hold_bias(bool held) { bias_held_ = held; }
  /// A match says that over the time since the last one the vehicle has turned further than
  /// `pose()` by this much: what differs over seconds is the gyro's bias. Precondition: the gyro
  /// told the turn, and the vehicle turned little, or errors of scale are taken for bias.
  void correct_bias(float turned_further_rad);
  /// Advances odom_T_base to the end of the increment.
  void add(const WheelIncrement& increment);

  /// Pose at the end of the last increment; the origin before the first.
  [[nodiscard]] const StampedPose& pose() const { return pose_; }
  /// Mean velocity over the last increment.
  [[nodiscard]] const Twist2& base_twist() const { return twist_; }
  [[nodiscard]] float gyro_bias_radps() const { return static_cast<float>(bias_radps_); }
  /// The last increment ended with an angle of the gyro.
  [[nodiscard]] bool turns_by_gyro() const { return used_gyro_; }
  [[nodiscard]] bool gyro_bias_known() const { return bias_count_ >= config_.bias_samples; }
  [[nodiscard]] Timestamp last_gyro_stamp() const { return newest().stamp; }
  [[nodiscard]] const DeadReckoningCounters& counters() const { return counters_; }

 private:
  struct GyroAngle {
    Timestamp stamp{};
    double angle_rad = 0.0;  ///< integral of rate minus bias
    double rate_radps = 0.0;
  };
  struct StandingBlock {
    double sum_radps = 0.0;
    int samples = 0;
  };
  static constexpr std::size_t kAngles = 16;

  [[nodiscard]] const GyroAngle& newest() const { return angles_[(next_ + kAngles - 1) % kAngles]; }
  [[nodiscard]] Result<double> gyro_angle_at(Timestamp stamp) const;
  void add_standing(Timestamp stamp, double rate_radps);

  DeadReckoningConfig config_;
  StampedPose pose_{};
  Twist2 twist_{};
  std::array<GyroAngle, kAngles> angles_{};
  std::size_t next_ = 0;
  std::size_t held_ = 0;
  double bias_radps_ = 0.0;
  int bias_count_ = 0;
  StandingBlock block_{};       // at standstill
  StandingBlock last_block_{};  // complete, yet the wheels may have been about to count
  Timestamp block_since_{};
  Timestamp standing_since_{};
  bool standing_ = false;
  bool bias_held_ = false;
  double used_angle_rad_ = 0.0;  ///< gyro angle at pose_.stamp, as it was used
  Timestamp used_stamp_{};
  bool used_gyro_ = false;
  DeadReckoningCounters counters_{};
};

}  // namespace picolo::inline v0
