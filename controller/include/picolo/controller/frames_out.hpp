// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the controller says on the CAN bus, message by message: can_table.hpp says how it looks.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "picolo/calibration/parameter.hpp"
#include "picolo/controller/can_codec.hpp"
#include "picolo/controller/controller_config.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/localisation/event_ring.hpp"
#include "picolo/localisation/pose_estimate.hpp"

namespace picolo::inline v0 {

struct CalibrationProgress {
  CalibrationPhase phase = CalibrationPhase::idle;
  std::uint8_t procedure = 0;
  std::uint8_t percent = 0;
  Refusal refusal{};
  std::uint32_t samples = 0;
  Duration elapsed{};
};

/// Percent of the information needed, by parameter; kNoPercent where there is nothing to tell.
struct CalibrationHint {
  static constexpr std::uint8_t kNoPercent = 127;
  DriveAdvice advice = DriveAdvice::none;
  std::uint8_t wheels = kNoPercent;
  std::uint8_t track = kNoPercent;
  std::uint8_t lidar_xy = kNoPercent;
  std::uint8_t lidar_yaw = kNoPercent;
  std::uint8_t time_offset = kNoPercent;
  std::uint8_t gyro = kNoPercent;
};

/// One answer of a calibration, in the parameter's unit.
struct CalibrationValue {
  Parameter parameter = Parameter::none;
  Estimate estimate{};
};

/// Number of a command, as PicoloReply names it.
enum class CommandKind : std::uint8_t {
  set_pose,
  set_mode,
  save_map,
  load_map,
  start_calibration,
  abort_calibration,
  read_events,
};
inline constexpr std::size_t kCommandKinds = 7;

struct CommandReply {
  CommandKind command = CommandKind::set_pose;
  std::uint8_t counter = 0;  ///< of the command
  CommandResult result = CommandResult::done;
  std::uint8_t detail = 0;
  std::uint32_t accepted = 0;
  std::uint32_t refused = 0;
};

/// The controller's time as commands must repeat it: quarters of a second, modulo 256.
[[nodiscard]] std::uint8_t can_tick(Timestamp now);

/// Each call makes one frame and counts on that message's counter. The frame's stamp is that of
/// what it tells. Cost: O(1). Context: cycle only.
class FramesOut {
 public:
  explicit FramesOut(std::uint16_t base_id) : base_id_(base_id) {}

  [[nodiscard]] CanFrame pose(const PoseEstimate& estimate);
  [[nodiscard]] CanFrame health(const PoseEstimate& estimate, OperatingMode mode, Timestamp now);
  [[nodiscard]] CanFrame twist(const PoseEstimate& estimate);
  [[nodiscard]] CanFrame time(const PoseEstimate& estimate);
  [[nodiscard]] CanFrame match_sigma(const PoseEstimate& estimate);
  [[nodiscard]] CanFrame drift_sigma(const PoseEstimate& estimate);
  [[nodiscard]] CanFrame correlation(const PoseEstimate& estimate);
  /// `index`: of the event since the ring's start.
  [[nodiscard]] CanFrame event(const Event& event, std::uint32_t index);
  [[nodiscard]] CanFrame event_time(const Event& event, std::uint32_t index);
  [[nodiscard]] CanFrame counter(CounterIndex which, std::uint32_t value);
  [[nodiscard]] CanFrame calibration(const CalibrationProgress& progress);
  [[nodiscard]] CanFrame calibration_hint(const CalibrationHint& hint);
  [[nodiscard]] CanFrame calibration_value(const CalibrationValue& value);
  [[nodiscard]] CanFrame reply(const CommandReply& reply);

 private:
  [[nodiscard]] CanFrame next(const CanLayout& layout, Timestamp stamp,
                              std::span<const std::int64_t> raw);
  [[nodiscard]] CanFrame sigmas(const CanLayout& layout, Timestamp stamp,
                                const Matrix3f& covariance);

  std::uint16_t base_id_;
  std::array<std::uint8_t, kCanOwnIds> counters_{};
};

}  // namespace picolo::inline v0
