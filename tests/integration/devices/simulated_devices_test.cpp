// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Every device in the simulated vehicle: chosen by name, through its own bytes, to a pose.

#include <gtest/gtest.h>

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "picolo/core/random.hpp"
#include "picolo/devices/dialects.hpp"
#include "picolo/devices/registry.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/sensing/sweep.hpp"
#include "picolo/simulated/simulated_controller.hpp"

namespace picolo::test {
namespace {

struct Choice {
  std::string wheels;
  std::string lidar;
  std::string imu;
  double worst_m;  ///< the encoders of some are coarse
  std::string lidar_mode{};
};

using DeviceController = Controller<RoomProfile, devices::Wheels, devices::Lidar, devices::Imu>;

/// A DBC file of our own with the two angles that the dialect sends.
std::string dbc_file() {
  const auto path = std::filesystem::temp_directory_path() /
                    ("picolo_devices_" + std::to_string(::getpid()) + ".dbc");
  std::ofstream{path} << "BO_ 517 MOTORS_ANGLE: 8 X\n SG_ LEFT : 7|16@0+ (1,0) [0|16384] \"\" X\n"
                         " SG_ RIGHT : 23|16@0+ (1,0) [0|16384] \"\" X\n";
  return path.string();
}

void drive(const Choice& choice) {
  SCOPED_TRACE(choice.wheels + " " + choice.lidar + " " + choice.imu);
  auto simulation = std::make_unique<sim::Simulation>(sim::SimulationConfig{
      .seed = 3, .lidar = {.counter_clockwise = devices::turns_counter_clockwise(choice.lidar)}});
  constexpr std::uint32_t kPolePairs = 50;
  const auto bus = devices::make_wheel_dialect(choice.wheels, simulation->can(),
                                               simulation->clock(), {.pole_pairs = kPolePairs});
  const auto lidar_port =
      devices::make_lidar_dialect(choice.lidar, simulation->lidar_port(), choice.lidar_mode);
  const auto imu_port = devices::make_imu_dialect(choice.imu, simulation->imu_port());
  devices::WheelsSettings wheels_settings{.produce_sync = true, .pole_pairs = kPolePairs};
  if (choice.wheels == "dbc") {
    wheels_settings.dbc_file = dbc_file();
    wheels_settings.left_signal = "MOTORS_ANGLE.LEFT";
    wheels_settings.right_signal = "MOTORS_ANGLE.RIGHT";
    wheels_settings.counts_per_turn = 16'384;
  }
  const auto wheels = devices::make_wheels(choice.wheels, *bus, wheels_settings);
  const auto lidar = devices::make_lidar(choice.lidar, *lidar_port,
                                         {.mode = choice.lidar_mode, .samples_per_second = 4500});
  const auto imu = devices::make_imu(choice.imu, *imu_port);
  ControllerConfig config = simulated_vehicle_config();
  if (choice.wheels == "vesc") { config.drive.counts_per_revolution = 6.0 * kPolePairs; }
  EventRing events;
  auto controller = std::make_unique<DeviceController>(
      Board{*bus, simulation->clock(), simulation->cycle_counter(), simulation->watchdog()},
      *wheels, *lidar, *imu, events, config);
  ASSERT_EQ(controller->start(), Status::ok);
  double worst_m = 0.0;
  int tracking = 0;
  int frames = 0;
  while (simulation->now() < Timestamp{25s}) {
    simulation->advance_to(controller->next_frame());
    static_cast<void>(controller->run_frame());
    if (simulation->now() < Timestamp{5s}) { continue; }
    ++frames;
    const PoseEstimate& estimate = controller->estimate();
    tracking += estimate.state == HealthState::tracking ? 1 : 0;
    const auto truth = simulation->truth(estimate.stamp);
    ASSERT_TRUE(truth);
    const Pose2d expected = between(simulation->config().scene.world_T_start, truth->world_T_base);
    worst_m = std::max(worst_m, std::hypot(estimate.map_T_base.x_m - expected.x_m,
                                           estimate.map_T_base.y_m - expected.y_m));
  }
  EXPECT_LT(worst_m, choice.worst_m);
  EXPECT_GT(tracking, frames * 9 / 10);
  std::cout << choice.wheels << " " << choice.lidar << " " << choice.imu << ": worst " << worst_m
            << " m, tracking " << 100 * tracking / frames << " %\n";
  for (const devices::Counter& counter : lidar->counters()) {
    if (counter.name == "bad_checksums") { EXPECT_EQ(counter.value, 0U); }
  }
  EXPECT_TRUE(lidar->trouble().empty()) << lidar->trouble();
  while (lidar->stop() == Status::not_ready) {}
}

TEST(SimulatedDevices, GivenEachDeviceInTurnThenTheVehicleKnowsWhereItIs) {
  for (const Choice& choice :
       {Choice{"canopen", "ld06", "witmotion", 0.15}, Choice{"vesc", "ld06", "witmotion", 0.15},
        Choice{"odrive", "rplidar", "xsens", 0.15},
        Choice{"vesc", "ydlidar", "bno08x-rvc", 0.25, "tmini"},
        Choice{"dbc", "rplidar", "vectornav", 0.15, "dense"},
        Choice{"odrive", "rplidar", "xsens", 0.15, "ultra"},
        Choice{"odrive", "rplidar", "witmotion", 0.15, "express"},
        Choice{"canopen", "scip", "witmotion", 0.15}}) {
    drive(choice);
  }
}

/// Stamps of the read, as a busy machine takes them: late, and several packets at once.
class LatePort final : public SerialPort {
 public:
  LatePort(SerialPort& inner, Clock& clock) : inner_(inner), clock_(clock) {}
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    Result<SerialRead> read = inner_.read(buffer);
    if (!read) { return read.status(); }
    const Duration late = clock_.now() - read->last_byte_stamp;
    shortest_ = std::min(shortest_, late);
    longest_ = std::max(longest_, late);
    return SerialRead{read->size, clock_.now(), StampSource::read};
  }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    return inner_.write(bytes);
  }
  [[nodiscard]] std::uint32_t baud() const override { return inner_.baud(); }
  [[nodiscard]] std::uint32_t lost() const override { return inner_.lost(); }
  [[nodiscard]] Duration jitter() const {
    return shortest_ <= longest_ ? longest_ - shortest_ : Duration{0};
  }

 private:
  SerialPort& inner_;
  Clock& clock_;
  Duration shortest_ = Duration::max();
  Duration longest_ = Duration::min();
};

struct SweepTimes {
  std::vector<Timestamp> first;
  Duration input_jitter{};
};

/// Half a minute of a lidar's sweeps; `late`: read after irregular pauses of up to 30 ms.
SweepTimes sweep_times(const std::string& name, const std::string& mode, bool late) {
  // 10 s before a SCIP lidar's clock wraps, 13 s before an LD06's.
  auto simulation = std::make_unique<sim::Simulation>(sim::SimulationConfig{
      .seed = 5,
      .start = Timestamp{16'777'216ms - 10s},
      .lidar = {.counter_clockwise = devices::turns_counter_clockwise(name)}});
  const auto port = devices::make_lidar_dialect(name, simulation->lidar_port(), mode);
  LatePort late_port{*port, simulation->clock()};
  const auto lidar =
      devices::make_lidar(name, late ? static_cast<SerialPort&>(late_port) : *port,
                          {.mode = name == "ydlidar" ? "tmini" : mode, .samples_per_second = 4500});
  SweepAssembler<1000> assembler;
  Random random{9};
  SweepTimes times;
  Timestamp end{};
  std::array<RangeReading, 64> readings{};
  const Timestamp start = simulation->now();
  for (Timestamp now = start; now < start + 30s;) {
    now += late ? Duration{1000 * (1 + random.below(30))} : Duration{1000};
    simulation->advance_to(now);
    static_cast<void>(lidar->service(now));
    for (auto n = lidar->poll(4096, readings); n; n = lidar->poll(4096, readings)) {
      for (const RangeReading& reading : std::span{readings}.first(*n)) {
        assembler.add(reading);
        if (!assembler.ready()) { continue; }
        const Sweep sweep = assembler.take();
        EXPECT_GE(sweep.stamp, end) << "sweeps overlap";
        EXPECT_EQ(sweep.returns.front().since_sweep_start_s, 0.0F);
        EXPECT_NEAR(static_cast<double>(sweep.returns.back().since_sweep_start_s),
                    to_seconds_f64(sweep.last_stamp - sweep.stamp), 1e-5);
        end = sweep.last_stamp;
        times.first.push_back(sweep.stamp);
      }
    }
  }
  times.input_jitter = late_port.jitter();
  return times;
}

TEST(SimulatedDevices, GivenLateReadingThenSweepsNeverOverlapAndHaveNoMoreJitterThanTheirStamps) {
  for (const auto& [name, mode] : {std::pair{"ld06", ""},
                                   {"rplidar", ""},
                                   {"rplidar", "express"},
                                   {"rplidar", "ultra"},
                                   {"rplidar", "dense"},
                                   {"ydlidar", ""},
                                   {"scip", ""}}) {
    SCOPED_TRACE(std::string{name} + " " + mode);
    const SweepTimes exact = sweep_times(name, mode, false);
    const SweepTimes late = sweep_times(name, mode, true);
    ASSERT_GT(late.first.size(), 250U);
    Duration shortest = Duration::max();
    Duration longest = Duration::min();
    std::size_t at = 0;
    for (const Timestamp stamp : late.first) {
      if (stamp < late.first.front() + 2s) { continue; }
      while (at + 1 < exact.first.size() && exact.first[at + 1] <= stamp + 50ms) { ++at; }
      if (at + 1 == exact.first.size()) { break; }
      const Duration difference = stamp - exact.first[at];
      shortest = std::min(shortest, difference);
      longest = std::max(longest, difference);
    }
    std::cout << name << " " << mode << ": input jitter " << late.input_jitter.count()
              << " us, output " << (longest - shortest).count() << " us, " << late.first.size()
              << " sweeps\n";
    EXPECT_LE(longest - shortest, late.input_jitter);
  }
}

TEST(SimulatedDevices, GivenUnknownNamesThenTheMessageNamesWhatThereIs) {
  sim::SimClock clock{Timestamp{}};
  sim::SimSerialPort port{clock, 115'200};
  EXPECT_THROW(static_cast<void>(devices::make_lidar_dialect("sonar", port)),
               std::invalid_argument);
  try {
    static_cast<void>(devices::make_lidar("sick", port));
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string{error.what()}.find("ld06, rplidar, scip, ydlidar"), std::string::npos);
  }
  EXPECT_NE(devices::find_device(devices::Kind::imu, "xsens"), nullptr);
  EXPECT_EQ(devices::find_device(devices::Kind::imu, "ld06"), nullptr);
}

}  // namespace
}  // namespace picolo::test
