// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Everything that an MPS2 board has for the controller, connected to its interrupts.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/board/memory_byte_store.hpp"
#include "picolo/mps2/board_clock.hpp"
#include "picolo/mps2/cmsdk_uart.hpp"
#include "picolo/mps2/cmsdk_watchdog.hpp"
#include "picolo/mps2/host_pace.hpp"

namespace picolo::inline v0::mps2 {

struct BoardConfig {
  std::uint32_t can_baud = 1'000'000;  ///< of the serial CAN adapter on the first UART
  std::uint32_t lidar_baud = 230'400;  ///< second UART
  std::uint32_t imu_baud = 115'200;    ///< third UART
  std::uint32_t first_count = 0;       ///< see BoardClock
};

inline constexpr std::size_t kStoreBytes = std::size_t{1} << 20;
inline constexpr std::size_t kStoreSector = 4096;

/// One a program; interrupts find it. Members are the devices themselves: this is the one place
/// that knows which is which.
class Mps2Board {
 public:
  explicit Mps2Board(const BoardConfig& config);
  Mps2Board(const Mps2Board&) = delete;
  Mps2Board& operator=(const Mps2Board&) = delete;
  ~Mps2Board() = default;

  /// Bytes arrive and SysTick ticks from then on.
  void start(Duration minor_frame);
  /// Bytes on all UARTs of the robot, modulo 2^32.
  [[nodiscard]] std::uint32_t bytes_arrived() const;
  /// Does what an external interrupt asks for.
  void on_interrupt(unsigned number);

  BoardClock clock;
  BoardCycles cycles{};
  FrameTimer frame_timer{};
  CmsdkUart can;
  CmsdkUart lidar;
  CmsdkUart imu;
  CmsdkWatchdog watchdog{};
  HostPace pace;
  board::MemoryByteStore store;
};

}  // namespace picolo::inline v0::mps2
