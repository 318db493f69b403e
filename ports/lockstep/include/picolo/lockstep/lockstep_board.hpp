// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One packet a minor frame in, one reply out. What happened is in the packet, so that any
/// processor that is given the same packets must give the same replies.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/lockstep/lockstep_devices.hpp"

namespace picolo::inline v0::lockstep {

/// Packet, little-endian: u16 size of all, i64 time in microseconds, u8 CAN frames, u16 bytes of
/// the lidar, u16 of the IMU; a CAN frame: u32 age, u16 identifier, u8 length, 8 bytes; a byte: u16
/// age, u8; u32 CRC. Ages are microseconds before the packet's time. A packet without content after
/// its time ends the run.
inline constexpr std::size_t kMaxPacket = 8192;
inline constexpr std::size_t kHeader = 15;

/// What the host puts into a packet.
class PacketWriter {
 public:
  explicit PacketWriter(Timestamp now);
  void add(const CanFrame& frame);
  /// All bytes of the lidar come before those of the IMU, all CAN frames before both.
  void add_lidar(std::uint8_t byte, Timestamp stamp);
  void add_imu(std::uint8_t byte, Timestamp stamp);
  /// The whole packet; nothing may be added after it.
  [[nodiscard]] ByteView finish();

 private:
  void add_byte(std::uint8_t byte, Timestamp stamp);
  [[nodiscard]] std::uint32_t age(Timestamp stamp, std::uint32_t most) const;

  Timestamp now_;
  std::uint8_t bytes_[kMaxPacket]{};
  std::size_t size_ = kHeader;
  std::uint8_t frames_ = 0;
  std::uint16_t lidar_ = 0;
  std::uint16_t imu_ = 0;
};

/// Not small (40 KB): keep it in static storage. Context: one.
class LockstepBoard {
 public:
  LockstepBoard(std::uint32_t lidar_baud, std::uint32_t imu_baud)
      : lidar_(lidar_baud), imu_(imu_baud) {}
  LockstepBoard(const LockstepBoard&) = delete;
  LockstepBoard& operator=(const LockstepBoard&) = delete;
  ~LockstepBoard() = default;

  /// Sets the clock and fills the devices. `checksum`, `invalid_argument`: nothing was taken.
  Status take(ByteView packet);

  [[nodiscard]] LockstepClock& clock() { return clock_; }
  [[nodiscard]] LockstepCanBus& can() { return can_; }
  [[nodiscard]] LockstepSerialPort& lidar() { return lidar_; }
  [[nodiscard]] LockstepSerialPort& imu() { return imu_; }
  [[nodiscard]] LockstepWatchdog& watchdog() { return watchdog_; }

 private:
  LockstepClock clock_{};
  LockstepCanBus can_{};
  LockstepSerialPort lidar_;
  LockstepSerialPort imu_;
  LockstepWatchdog watchdog_{};
};

}  // namespace picolo::inline v0::lockstep
