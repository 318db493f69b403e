// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The installed controller with the real drivers on a board that lives from packets: what an image
/// runs, and its twin on the host.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/controller/controller.hpp"
#include "picolo/core/bytes.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"
#include "picolo/lockstep/lockstep_board.hpp"
#include "picolo/sim/ld06_wire.hpp"
#include "picolo/sim/wheel_pair.hpp"
#include "picolo/sim/witmotion_model.hpp"
#include "picolo/simulated/simulated_controller.hpp"
#include "picolo/simulated/trajectory_hash.hpp"

namespace picolo::inline v0 {

/// Ticks of each task in one frame.
struct TaskTicks {
  std::array<std::uint32_t, kControllerTasks> ticks{};
  void ran(std::size_t task, std::uint32_t cycles) { ticks[task] = cycles; }
};

template <Profile P>
class LockstepController {
 public:
  using Type = Controller<P, CanopenWheels, Ld06, WitMotion>;
  static constexpr std::size_t kMaxReply = 512;

  explicit LockstepController(CycleCounter& cycle_counter,
                              const ControllerConfig& config = simulated_vehicle_config(),
                              const ControllerServices& services = {})
      : board_(sim::kLd06Baud, sim::WitMotionModelConfig{}.baud),
        wheels_(board_.can(), simulated_wheels_config()),
        lidar_(board_.lidar()),
        imu_(board_.imu()),
        controller_({board_.can(), board_.clock(), cycle_counter, board_.watchdog()}, wheels_,
                    lidar_, imu_, events_, config, services) {}
  LockstepController(const LockstepController&) = delete;
  LockstepController& operator=(const LockstepController&) = delete;
  ~LockstepController() = default;

  /// The first packet starts the controller; each runs one frame.
  Status take(ByteView packet) {
    const Status status = board_.take(packet);
    if (!is_ok(status) || started_) { return status; }
    started_ = true;
    return controller_.start();
  }
  Status run_frame(TaskTicks& ticks) { return controller_.run_frame(ticks); }

  /// Status, hash of the published estimate, frames on the bus: equal on every processor. Returns
  /// its size.
  std::size_t reply(Status status, std::span<std::uint8_t> bytes) {
    TrajectoryHash hash{Timestamp{}};
    hash.add(controller_.estimate());
    bytes[0] = static_cast<std::uint8_t>(status);
    store_u32_le(bytes, 1, static_cast<std::uint32_t>(hash.value() & 0xFFFFFFFFU));
    store_u32_le(bytes, 5, static_cast<std::uint32_t>(hash.value() >> 32));
    const std::span<const CanFrame> sent = board_.can().sent();
    bytes[9] = static_cast<std::uint8_t>(sent.size());
    std::size_t at = 10;
    for (const CanFrame& frame : sent) {
      store_u16_le(bytes, at, static_cast<std::uint16_t>(frame.id));
      bytes[at + 2] = frame.length;
      for (std::size_t i = 0; i < 8; ++i) {
        bytes[at + 3 + i] = i < frame.length ? frame.data[i] : std::uint8_t{0};
      }
      at += 11;
    }
    return at;
  }

  [[nodiscard]] lockstep::LockstepBoard& board() { return board_; }
  [[nodiscard]] const Type& controller() const { return controller_; }

 private:
  lockstep::LockstepBoard board_;
  CanopenWheels wheels_;
  Ld06 lidar_;
  WitMotion imu_;
  EventRing events_{};
  Type controller_;
  bool started_ = false;
};

}  // namespace picolo::inline v0
