// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Wheels driven by VESCs: odometry from the tachometer of STATUS_5.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/drivers/common/wheel_collector.hpp"
#include "picolo/drivers/vesc/vesc_messages.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/can_filter.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

struct VescWheelConfig {
  std::uint8_t vesc = 0;
  bool inverted = false;
};

struct VescWheelsConfig {
  std::array<VescWheelConfig, kMaxWheels> wheels{{{.vesc = 1}, {.vesc = 2}}};
  int wheel_count = 2;
  std::uint16_t pole_pairs = 7;
  std::uint32_t max_erpm = 150'000;  ///< a step beyond is a restart
  /// VESCs send at their own times: longer than their jitter, shorter than their period (20 ms).
  Duration pair_window = 18ms;
  Duration timeout = 500ms;
  [[nodiscard]] constexpr std::uint32_t counts_per_turn() const { return 6U * pole_pairs; }
  [[nodiscard]] constexpr bool valid() const {
    if (wheel_count < 1 || wheel_count > kMaxWheels) { return false; }
    for (std::size_t i = 0; i < static_cast<std::size_t>(wheel_count); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        if (wheels[i].vesc == wheels[k].vesc) { return false; }
      }
    }
    return pole_pairs > 0 && max_erpm >= 10 && max_erpm <= 10'000'000 &&
           pair_window > Duration{0} && timeout > Duration{0};
  }
};

/// Satisfies WheelDevice. Precondition: config.valid(). Context: one at a time. No heap.
class VescWheels {
 public:
  explicit VescWheels(const VescWheelsConfig& config);

  bool consume(const CanFrame& frame);
  [[nodiscard]] Result<WheelTicks> take() { return collector_.take(); }
  /// Notices who fell silent.
  Status service(Timestamp now);
  [[nodiscard]] bool healthy() const;
  /// Last electrical revolutions a minute of STATUS; noisy near 0.
  [[nodiscard]] std::int32_t erpm(std::size_t wheel) const { return erpm_[wheel]; }
  [[nodiscard]] CanWheelsCounters counters() const;
  using Filters = FixedVector<CanFilter, 2 * kMaxWheels>;
  [[nodiscard]] Filters filters() const;

 private:
  [[nodiscard]] std::size_t wheels() const { return static_cast<std::size_t>(config_.wheel_count); }

  VescWheelsConfig config_;
  WheelCollector collector_;
  std::array<std::int32_t, kMaxWheels> erpm_{};
  std::array<Timestamp, kMaxWheels> last_heard_{};
  std::array<bool, kMaxWheels> alive_{};
  std::array<bool, kMaxWheels> lost_{};
  CanWheelsCounters counters_{};
};

}  // namespace picolo::inline v0
