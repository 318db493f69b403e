// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which frames go out with which report.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/controller/frames_out.hpp"
#include "picolo/controller/services.hpp"
#include "picolo/hal/can_bus.hpp"

namespace picolo::inline v0 {

using CounterValues = std::array<std::uint32_t, kCounterCount>;

/// What one report tells.
struct ReportInputs {
  Timestamp now{};
  const PoseEstimate& estimate;
  OperatingMode mode = OperatingMode::mapping;
  const EventRing& events;
  const CounterValues& counters;
  const CalibrationService* calibration = nullptr;
};

/// At most 12 frames a report. Context: cycle only.
class Reporter {
 public:
  Reporter(const FramesOutConfig& config, CanBus& can)
      : enabled_(config.enabled), can_(can), frames_(config.base_id) {}

  void report(const ReportInputs& inputs);
  void reply(const CommandReply& reply);
  /// Events from this index of the ring's life on go out (again).
  void read_events(const EventRing& events, std::uint16_t index);

  [[nodiscard]] std::uint32_t sent() const { return sent_; }
  /// The bus had no room; they are not repeated, the next ones are newer.
  [[nodiscard]] std::uint32_t refused() const { return refused_; }

 private:
  void send(const CanFrame& frame);
  void tell_pose(const ReportInputs& inputs);
  void tell_event(const EventRing& events);
  void tell_counter(const CounterValues& counters);
  void tell_calibration(const CalibrationService& calibration);

  bool enabled_;
  CanBus& can_;
  FramesOut frames_;
  std::uint32_t next_event_ = 0;  // index of the ring's life
  std::uint8_t reports_ = 0;
  std::uint8_t next_counter_ = 0;
  std::uint8_t next_value_ = 0;
  std::uint32_t sent_ = 0;
  std::uint32_t refused_ = 0;
};

}  // namespace picolo::inline v0
