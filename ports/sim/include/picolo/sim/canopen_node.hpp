// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A CANopen wheel encoder or drive: CiA 301 start-up, heartbeat, SYNC, one transmit PDO with the
/// position of CiA 402.
#pragma once

#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/sim/canopen_objects.hpp"
#include "picolo/sim/links.hpp"

namespace picolo::inline v0::sim {

/// What the shaft shows at an instant.
struct EncoderReading {
  std::int64_t counts = 0;  ///< since power-up, unbounded
  std::int64_t counts_per_s = 0;
};

class EncoderSource {
 public:
  [[nodiscard]] virtual EncoderReading reading_at(Timestamp instant) = 0;

 protected:
  EncoderSource() = default;
  EncoderSource(const EncoderSource&) = default;
  EncoderSource& operator=(const EncoderSource&) = default;
  ~EncoderSource() = default;
};

struct CanopenNodeConfig {
  std::uint8_t node = 1;
  Duration boot_time = 30ms;  ///< from power-up to the boot-up message
  Duration heartbeat_period = 100ms;
  std::uint8_t syncs_per_pdo = 1;      ///< transmission type 1..240
  bool with_velocity = true;           ///< i32 0x606C behind the i32 position 0x6064
  std::uint64_t modulus = 1ULL << 32;  ///< the position wraps in [0, modulus); 2^32: all of an i32
  std::int64_t initial_counts = 0;     ///< position at power-up
  bool reversed = false;               ///< counts fall when the wheel rolls forward
  [[nodiscard]] constexpr bool valid() const {
    return node >= 1 && node <= 127 && syncs_per_pdo >= 1 && syncs_per_pdo <= 240 && modulus >= 2 &&
           modulus <= (1ULL << 32) && heartbeat_period > Duration{0};
  }
};

/// The values are those of the heartbeat.
enum class NmtState : std::uint8_t {
  booting = 0x00,
  stopped = 0x04,
  operational = 0x05,
  pre_operational = 0x7F
};

/// Sends nothing but boot-up and heartbeats until it is started by NMT. Samples its shaft at the
/// end of the SYNC frame. Service data reads and changes heartbeat time and TPDO1 until the next
/// boot.
class CanopenNode {
 public:
  CanopenNode(const CanopenNodeConfig& config, EncoderSource& source, CanLink& link,
              Timestamp power_up);

  /// A frame of somebody else has passed the bus.
  void hear(const CanFrame& frame);
  /// Boot-up, heartbeats, power loss.
  void advance_to(Timestamp now);
  [[nodiscard]] NmtState state() const { return state_; }

 private:
  void boot(Timestamp power_up);
  void network_management(const CanFrame& frame);
  void send_pdo(Timestamp sync);
  void send_heartbeat(Timestamp when);

  CanopenNodeConfig config_;
  CanopenObjects objects_;
  EncoderSource& source_;
  CanLink& link_;
  NmtState state_ = NmtState::booting;
  Timestamp next_event_{};  ///< boot-up message or heartbeat
  std::int64_t counts_at_power_up_ = 0;
  std::uint8_t syncs_ = 0;
  bool powered_ = true;
  EncoderReading frozen_{};
};

}  // namespace picolo::inline v0::sim
