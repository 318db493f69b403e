// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A recorded log played stop-and-scan through the wires: the controller cannot tell it from a
/// vehicle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/sim/beam_packets.hpp"
#include "picolo/sim/fault_plan.hpp"
#include "picolo/sim/ld06_wire.hpp"
#include "picolo/sim/links.hpp"
#include "picolo/sim/ring.hpp"
#include "picolo/sim/sim_can_bus.hpp"
#include "picolo/sim/sim_clock.hpp"
#include "picolo/sim/sim_serial_port.hpp"
#include "picolo/sim/sim_watchdog.hpp"
#include "picolo/sim/wheel_pair.hpp"
#include "picolo/sim/wheel_script.hpp"

namespace picolo::inline v0::sim {

/// One scan of the log. The beams stay with the caller.
struct LogStep {
  Pose2d odom_T_base{};
  std::span<const RecordedBeam> beams{};
};

struct LogPlayerConfig {
  Timestamp start{};
  WheelScriptConfig script{};
  WheelPairConfig wheels{};
  Duration start_up = 500ms;  ///< standing before the first scan: the nodes boot and are started
  /// Standing after a scan, so that its match ends before the next movement.
  Duration think_time = 150ms;
  std::uint32_t can_bit_rate = 500'000;
  Duration watchdog_period = 500ms;
  FaultList faults{};
  std::uint64_t seed = 1;  ///< of the faults; nothing else is random
  [[nodiscard]] constexpr bool valid() const {
    return script.valid() && wheels.valid() && start_up > Duration{0} && think_time >= 60ms &&
           can_bit_rate > 0;
  }
};

/// Between scans the wheels move by WheelScript. Then the vehicle stands while the lidar, silent
/// until then, sends half an empty revolution, one revolution that carries the scan's beams, and
/// one packet of the next, so that a driver sees where the revolution begins and ends.
/// Deterministic; no heap; about 300 KB. Context: one.
class LogPlayer {
 public:
  /// Precondition: config.valid(). `steps` must outlive the player.
  LogPlayer(const LogPlayerConfig& config, std::span<const LogStep> steps);
  LogPlayer(const LogPlayer&) = delete;
  LogPlayer& operator=(const LogPlayer&) = delete;
  ~LogPlayer() = default;

  /// Lets everything live until `now`, then sets the clock to it. An earlier instant does nothing.
  void advance_to(Timestamp now);
  [[nodiscard]] Timestamp now() { return clock_.now(); }
  /// The last step's think time is over.
  [[nodiscard]] bool finished() const { return phase_ == Phase::finished; }

  [[nodiscard]] SimClock& clock() { return clock_; }
  [[nodiscard]] SimCycleCounter& cycle_counter() { return cycle_counter_; }
  [[nodiscard]] SimWatchdog& watchdog() { return watchdog_; }
  [[nodiscard]] SimCanBus& can() { return can_; }
  [[nodiscard]] SimSerialPort& lidar_port() { return lidar_port_; }

  /// Which step's revolution an instant lies in, e.g. the stamp of a sweep. `out_of_range`: none of
  /// the last 64.
  [[nodiscard]] Result<std::size_t> step_at(Timestamp instant) const;
  /// Steps whose revolution is completely sent.
  [[nodiscard]] std::size_t steps_played() const { return steps_played_; }
  /// Where the counts say that the vehicle stands after its current way, in the log's odometry
  /// frame.
  [[nodiscard]] const Pose2d& odom_T_base() const { return script_.odom_T_base(); }

 private:
  enum class Phase : std::uint8_t { moving, scanning, thinking, finished };
  struct Window {
    std::size_t step = 0;
    Timestamp begin{};
    Timestamp end{};
  };
  class Shaft final : public EncoderSource {
   public:
    Shaft(const WheelScript& script, std::size_t wheel) : script_(script), wheel_(wheel) {}
    [[nodiscard]] EncoderReading reading_at(Timestamp instant) override;

   private:
    const WheelScript& script_;
    std::size_t wheel_;
  };

  void live_one_step();
  void enter_scan();
  void leave_scan();
  void leave_thinking();
  [[nodiscard]] bool next_packet(Ld06Packet& packet);
  void send_packet();

  LogPlayerConfig config_;
  std::span<const LogStep> steps_;
  SimClock clock_;
  SimCycleCounter cycle_counter_;
  SimWatchdog watchdog_;
  SimCanBus can_;
  SimSerialPort lidar_port_;
  FaultPlan faults_;
  WheelScript script_;
  Shaft left_shaft_;
  Shaft right_shaft_;
  WheelPair wheels_;
  SerialLink lidar_link_;
  BeamPackets beams_{};

  Timestamp lived_until_;
  Phase phase_ = Phase::moving;
  Timestamp phase_end_;
  std::size_t step_ = 0;
  std::size_t steps_played_ = 0;
  Timestamp scan_begin_{};
  std::int64_t points_sent_ = 0;  ///< of the current scan, lead-in and lead-out included
  std::int32_t lead_in_cdeg_ = 0;
  bool revolution_begun_ = false;
  bool lead_out_sent_ = false;
  Window window_{};
  Ring<Window, 64> windows_{};
};

}  // namespace picolo::inline v0::sim
