// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Wheels driven by ODrives (CANSimple).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/common/wheel_collector.hpp"
#include "picolo/drivers/odrive/odrive_messages.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/can_filter.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

/// Where the position comes from.
enum class OdrivePosition : std::uint8_t {
  /// Turns as float, sent every 10 ms. The float loses resolution: 0.008 turns after 10^5 turns.
  estimates,
  /// 32-bit counts, on request every `request_period`. Exact for ever.
  counts,
};

struct OdriveWheelConfig {
  std::uint8_t node = 0;
  bool inverted = false;
};

struct OdriveWheelsConfig {
  std::array<OdriveWheelConfig, kMaxWheels> wheels{{{.node = 0}, {.node = 1}}};
  int wheel_count = 2;
  OdriveFirmware firmware = OdriveFirmware::from_0_5_4;
  OdrivePosition position = OdrivePosition::estimates;
  /// Ticks that a turn of the estimates is made of.
  std::uint32_t counts_per_turn = 4096;
  std::uint32_t max_counts_per_s = 819'200;  ///< a step beyond is a restart
  Duration request_period = 10ms;
  Duration pair_window = 8ms;
  Duration heartbeat_timeout = 500ms;
  [[nodiscard]] constexpr bool valid() const {
    if (wheel_count < 1 || wheel_count > kMaxWheels) { return false; }
    for (std::size_t i = 0; i < static_cast<std::size_t>(wheel_count); ++i) {
      if (wheels[i].node > kOdriveMaxNode) { return false; }
      for (std::size_t k = 0; k < i; ++k) {
        if (wheels[i].node == wheels[k].node) { return false; }
      }
    }
    return counts_per_turn > 0 && max_counts_per_s > 0 && request_period > Duration{0} &&
           pair_window > Duration{0} && heartbeat_timeout > Duration{0};
  }
};

/// What the heartbeats say.
struct OdriveAxis {
  OdriveHeartbeat heartbeat{};
  Timestamp last_heard{};
  bool heard = false;
  bool lost = false;
};

/// Satisfies WheelDevice. Precondition: config.valid(). Context: one at a time. No heap.
class OdriveWheels {
 public:
  OdriveWheels(CanBus& bus, const OdriveWheelsConfig& config);

  bool consume(const CanFrame& frame);
  [[nodiscard]] Result<WheelTicks> take() { return collector_.take(); }
  /// Heartbeat time-outs and requests. The bus's status when it refused a frame.
  Status service(Timestamp now);
  /// Every axis is heard and none is faulted.
  [[nodiscard]] bool healthy() const;
  [[nodiscard]] const OdriveAxis& axis(std::size_t wheel) const { return axes_[wheel]; }
  [[nodiscard]] CanWheelsCounters counters() const;
  using Filters = FixedVector<CanFilter, 2 * kMaxWheels>;
  [[nodiscard]] Filters filters() const;

 private:
  [[nodiscard]] std::size_t wheels() const { return static_cast<std::size_t>(config_.wheel_count); }
  void consume_heartbeat(std::size_t wheel, const CanFrame& frame);
  void consume_position(std::size_t wheel, const CanFrame& frame);

  CanBus& bus_;
  OdriveWheelsConfig config_;
  WheelCollector collector_;
  std::array<OdriveAxis, kMaxWheels> axes_{};
  Timestamp next_request_ = Timestamp::min();
  CanWheelsCounters counters_{};
};

}  // namespace picolo::inline v0
