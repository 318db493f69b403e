// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Wheels whose counts or speeds are signals of a CAN database.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/common/wheel_collector.hpp"
#include "picolo/drivers/dbc/dbc_signal.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/can_filter.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

enum class DbcQuantity : std::uint8_t {
  position,  ///< an integer that wraps at the modulus
  /// A speed, summed up over time. Cars send no direction of rotation: not for vehicles that
  /// reverse, unless the signal has a sign.
  speed,
};

struct DbcWheelConfig {
  std::uint32_t id = 0;
  bool extended = false;
  std::uint8_t frame_bytes = 8;
  DbcSignal signal{};
  DbcMultiplexer multiplexer{};
  DbcRules rules{};
  DbcQuantity quantity = DbcQuantity::position;
  /// For speeds: ticks a second = (raw * factor + offset) * ticks_per_unit.
  float factor = 1.0F;
  float offset = 0.0F;
  float ticks_per_unit = 1.0F;
  WheelCounterConfig counter{};
  [[nodiscard]] constexpr bool valid() const {
    const bool integer =
        signal.type == DbcType::unsigned_integer || signal.type == DbcType::signed_integer;
    const bool bits = signal.length >= 33 || counter.modulus <= (std::uint64_t{1} << signal.length);
    return frame_bytes <= 8 && signal.valid(frame_bytes) && rules.valid(frame_bytes) &&
           (!multiplexer.used || multiplexer.selector.valid(frame_bytes)) &&
           id <= (extended ? 0x1FFFFFFFU : 0x7FFU) && counter.valid() &&
           (quantity == DbcQuantity::speed || (integer && signal.length <= 32 && bits));
  }
};

struct DbcWheelsConfig {
  /// Signals of one message have the same rules.
  std::array<DbcWheelConfig, kMaxWheels> wheels{};
  int wheel_count = 2;
  Duration pair_window = 8ms;
  Duration max_silence = 500ms;  ///< a speed older than this is not carried on
  [[nodiscard]] constexpr bool valid() const {
    if (wheel_count < 1 || wheel_count > kMaxWheels) { return false; }
    for (std::size_t i = 0; i < static_cast<std::size_t>(wheel_count); ++i) {
      if (!wheels[i].valid()) { return false; }
    }
    return pair_window > Duration{0} && max_silence > Duration{0};
  }
};

/// Satisfies WheelDevice. Precondition: config.valid(). Context: one at a time. No heap.
class DbcWheels {
 public:
  explicit DbcWheels(const DbcWheelsConfig& config);

  bool consume(const CanFrame& frame);
  [[nodiscard]] Result<WheelTicks> take() { return collector_.take(); }
  Status service(Timestamp /*now*/) { return Status::ok; }
  [[nodiscard]] CanWheelsCounters counters() const;
  using Filters = FixedVector<CanFilter, kMaxWheels>;
  [[nodiscard]] Filters filters() const;

 private:
  struct Progress {
    std::int64_t ticks_q8 = 0;  ///< of summed-up speeds
    Timestamp last_stamp{};
    std::uint32_t last_counter = 0;
    bool started = false;
  };

  [[nodiscard]] std::size_t wheels() const { return static_cast<std::size_t>(config_.wheel_count); }
  void note_counter(std::size_t wheel, ByteView data);
  bool accept(std::size_t wheel, const CanFrame& frame);
  void decode(std::size_t wheel, const CanFrame& frame);
  void add_speed(std::size_t wheel, const CanFrame& frame, float speed);

  DbcWheelsConfig config_;
  WheelCollector collector_;
  std::array<Progress, kMaxWheels> progress_{};
  CanWheelsCounters counters_{};
};

}  // namespace picolo::inline v0
