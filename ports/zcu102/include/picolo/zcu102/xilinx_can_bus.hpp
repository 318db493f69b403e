// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The CAN controller of the Zynq family (classic CAN, FIFOs of 64 frames).
#pragma once

#include <cstdint>
#include <span>

#include "picolo/core/ring_buffer.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/can_filter.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/zcu102/board.hpp"

namespace picolo::inline v0::zcu102 {

/// `off` is the controller's configuration mode. `listen_only` receives and sends nothing, not even
/// acknowledgements. `loop_back` receives own frames and hears nobody. `sleep` ends with the next
/// frame on the bus.
enum class CanMode : std::uint8_t { off, normal, listen_only, loop_back, sleep };

struct XilinxCanConfig {
  std::uintptr_t base = kCan0;
  std::uint32_t clock_hz = 100'000'000;  ///< CAN reference clock
  std::uint32_t bit_rate = 500'000;
  Duration restart_delay = 100ms;  ///< from bus-off to the next attempt
};

/// Attach it to its interrupt, then open it. The interrupt empties the receive FIFO into a ring of
/// 128 frames and stamps each.
class XilinxCanBus final : public CanBus {
 public:
  constexpr XilinxCanBus(Clock& clock, const XilinxCanConfig& config)
      : clock_(clock), config_(config) {}
  XilinxCanBus(const XilinxCanBus&) = delete;
  XilinxCanBus& operator=(const XilinxCanBus&) = delete;
  ~XilinxCanBus() = default;

  /// Resets the controller and starts it in `mode`. `filters`: what to receive, none = all; more
  /// than four are merged, so that other frames may pass, too (see merge_filters).
  /// `invalid_argument`: no bit timing for the rate. `out_of_range`: more than 32 filters.
  Status open(std::span<const CanFilter> filters = {}, CanMode mode = CanMode::normal);
  /// Passes through `off`: what is on the wire just then is lost. Context: main.
  void set_mode(CanMode mode);
  /// As the controller's status says; a mode takes effect after 11 recessive bits.
  [[nodiscard]] CanMode mode() const;
  void on_interrupt();

  /// Also restarts a controller that went bus-off, `restart_delay` later.
  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override;
  /// `rx_lost`: an overflow of the controller's FIFO counts once, however many frames it cost.
  [[nodiscard]] CanStatus status() const override;

 private:
  void take_frame();
  [[nodiscard]] bool send_fifo_full() const;

  Clock& clock_;
  XilinxCanConfig config_;
  CanMode wanted_ = CanMode::off;
  CanStatus counts_{};
  SpscRing<CanFrame, 128> received_{};
  volatile std::uint32_t overflows_ = 0;
  volatile std::uint32_t errors_ = 0;
  volatile bool bus_off_ = false;
  Timestamp bus_off_since_{};
};

}  // namespace picolo::inline v0::zcu102
