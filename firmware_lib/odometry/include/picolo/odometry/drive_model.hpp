// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The wheels of a vehicle, whatever their model: a firmware links the one it uses.
#pragma once

#include "picolo/odometry/wheel_odometry.hpp"

namespace picolo::inline v0 {

/// Context: cycle only.
class DriveModel {
 public:
  /// See WheelOdometry.
  virtual Result<WheelIncrement> update(const WheelTicks& ticks) = 0;
  [[nodiscard]] virtual EncoderScale encoder_scale() const = 0;

 protected:
  DriveModel() = default;
  DriveModel(const DriveModel&) = default;
  DriveModel& operator=(const DriveModel&) = default;
  ~DriveModel() = default;
};

/// For example DriveModelOf<MecanumDrive> wheels{MecanumDriveConfig{...}}. Cost: the model's.
template <WheelOdometry W>
class DriveModelOf final : public DriveModel {
 public:
  template <typename Config>
  explicit DriveModelOf(const Config& config) : wheels_(config) {}

  Result<WheelIncrement> update(const WheelTicks& ticks) override { return wheels_.update(ticks); }
  [[nodiscard]] EncoderScale encoder_scale() const override { return wheels_.encoder_scale(); }

 private:
  W wheels_;
};

}  // namespace picolo::inline v0
