// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A vehicle with its sensors in a world, on simulated wires: everything that the controller of a
/// real one is connected to.
///
///   sim::Simulation simulation{{.seed = 7}};
///   ... a controller on simulation.clock(), can(), lidar_port(), imu_port(), watchdog() ...
///   for (Timestamp t = simulation.now(); ; t += 5ms) { simulation.advance_to(t); controller.run();
///   }
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/sim/drive_plan.hpp"
#include "picolo/sim/fault_plan.hpp"
#include "picolo/sim/ld06_model.hpp"
#include "picolo/sim/links.hpp"
#include "picolo/sim/scenes.hpp"
#include "picolo/sim/sim_byte_store.hpp"
#include "picolo/sim/sim_can_bus.hpp"
#include "picolo/sim/sim_clock.hpp"
#include "picolo/sim/sim_serial_port.hpp"
#include "picolo/sim/sim_watchdog.hpp"
#include "picolo/sim/vehicle.hpp"
#include "picolo/sim/wheel_pair.hpp"
#include "picolo/sim/witmotion_model.hpp"

namespace picolo::inline v0::sim {

inline constexpr std::size_t kSimStoreBytes = 65'536;

struct SimulationConfig {
  std::uint64_t seed = 1;
  Timestamp start{};  ///< what the clock shows at the beginning; nothing else depends on it
  Scene scene = make_scene(SceneName::office);
  TwistScript script{};  ///< when not empty: driven instead of the scene's route
  DriveLimits drive{};
  VehicleConfig vehicle{};
  WheelPairConfig wheels{};
  std::uint32_t counts_per_turn = 4096;  ///< of each wheel; at 0.1 m radius 0.153 mm each
  Ld06ModelConfig lidar{};
  WitMotionModelConfig imu{};
  std::uint32_t can_bit_rate = 500'000;
  Duration watchdog_period = 500ms;
  FaultList faults{};
  [[nodiscard]] constexpr bool valid() const {
    return drive.valid() && vehicle.valid() && wheels.valid() && lidar.valid() && imu.valid() &&
           can_bit_rate > 0 && counts_per_turn > 0;
  }
};

/// The true motion at an instant. A controller's map frame is world_T_start unless it was told
/// otherwise: map_T_base = world_T_start^-1 * world_T_base.
struct Truth {
  Timestamp stamp{};
  Pose2d world_T_base{};
  Twist2 twist{};                           ///< in base
  std::array<double, 2> wheel_angle_rad{};  ///< left, right
};

/// Deterministic: the same configuration and the same traffic from the firmware give the same bytes
/// at the same times on every platform, however time is cut into calls of `advance_to`. About 1 MB,
/// no heap: keep it in static storage or on the heap, not on the stack. Context: one.
class Simulation {
 public:
  /// Precondition: config.valid().
  explicit Simulation(const SimulationConfig& config);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  ~Simulation() = default;

  /// Lets vehicle, sensors and wires live until `now`, then sets the clock to it. An earlier
  /// instant does nothing.
  void advance_to(Timestamp now);
  [[nodiscard]] Timestamp now() { return clock_.now(); }

  // What a controller is given.
  [[nodiscard]] SimClock& clock() { return clock_; }
  [[nodiscard]] SimCycleCounter& cycle_counter() { return cycle_counter_; }
  [[nodiscard]] SimWatchdog& watchdog() { return watchdog_; }
  [[nodiscard]] SimCanBus& can() { return can_; }
  [[nodiscard]] SimSerialPort& lidar_port() { return lidar_port_; }
  [[nodiscard]] SimSerialPort& imu_port() { return imu_port_; }
  [[nodiscard]] SimByteStore& store() { return store_; }

  // What only a judge may look at.
  [[nodiscard]] Truth truth();
  /// The true motion at any instant of the last 8 s. `out_of_range`: older, or not reached yet.
  [[nodiscard]] Result<Truth> truth(Timestamp stamp) const;
  [[nodiscard]] const World& world() const { return config_.scene.world; }
  [[nodiscard]] const SimulationConfig& config() const { return config_; }
  [[nodiscard]] const FaultPlan& faults() const { return faults_; }
  [[nodiscard]] const WitMotionModel& imu() const { return imu_; }
  /// An open route or a script has come to its end.
  [[nodiscard]] bool drive_finished() const { return plan_.finished(); }

 private:
  /// A wheel's shaft as its encoder sees it.
  class Shaft final : public EncoderSource {
   public:
    Shaft(const Vehicle& vehicle, std::size_t wheel, std::uint32_t counts_per_turn,
          Timestamp start);
    [[nodiscard]] EncoderReading reading_at(Timestamp instant) override;

   private:
    const Vehicle& vehicle_;
    std::size_t wheel_;
    std::uint32_t counts_per_turn_;
    Timestamp start_;
  };

  void live_one_step();
  [[nodiscard]] Truth to_truth(const VehicleState& state) const;

  SimulationConfig config_;
  SimClock clock_;
  SimCycleCounter cycle_counter_;
  SimWatchdog watchdog_;
  SimCanBus can_;
  SimSerialPort lidar_port_;
  SimSerialPort imu_port_;
  std::array<std::uint8_t, kSimStoreBytes> store_memory_{};
  SimByteStore store_;
  FaultPlan faults_;
  Vehicle vehicle_;
  DrivePlan plan_;
  Ld06Model lidar_;
  WitMotionModel imu_;
  SerialLink lidar_link_;
  SerialLink imu_link_;
  Shaft left_shaft_;
  Shaft right_shaft_;
  WheelPair wheels_;
};

}  // namespace picolo::inline v0::sim
