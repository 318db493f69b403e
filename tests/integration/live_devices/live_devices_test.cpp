// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A vehicle of every device: the simulation speaks as it does, doctor finds nothing wrong, run
// drives with it, replay repeats it bit for bit. In real time on a machine that may be slow:
// nothing here asks for speed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <ostream>
#include <set>
#include <string>
#include <thread>

#include "picolo/devices/registry.hpp"
#include "process.hpp"

namespace picolo {
namespace {

using test::Process;
using test::TemporaryFolder;
using ::testing::HasSubstr;

struct Vehicle {
  std::string wheels, lidar, imu;
  std::string settings;    ///< of the configuration, beside the names
  std::string lidar_baud;  ///< at which the device really speaks; empty: at any
  std::string imu_baud;
  std::string finds;  ///< in the doctor's words
};
void PrintTo(const Vehicle& vehicle, std::ostream* out) {
  *out << vehicle.wheels << ' ' << vehicle.lidar << ' ' << vehicle.imu;
}

const Vehicle kVehicles[]{
    {"canopen", "ld06", "witmotion", "", "", "9600", "at 9600 baud, which picolo run finds"},
    {"odrive", "rplidar", "xsens", "[lidar]\nsamples_per_second = 4500\n", "256000", "921600",
     "at 256000 baud, which picolo run finds"},
    {"vesc", "ydlidar", "bno08x-rvc",
     "[vehicle]\ncounts_per_revolution = 300\n[wheels]\npole_pairs = 50\n[lidar]\nmode = "
     "\"tmini\"\nsamples_per_second = 4500\n",
     "230400", "", "samples of the wheels (vesc)"},
    {"dbc", "scip", "vectornav",
     "[wheels]\ndbc_file = \"wheels.dbc\"\nleft_signal = \"ANGLE.LEFT\"\n"
     "right_signal = \"ANGLE.RIGHT\"\ncounts_per_turn = 16384\n",
     "750000", "230400", "at 750000 baud, which picolo run finds"},
    {"odrive", "rplidar", "bno08x-rvc", "[lidar]\nmode = \"dense\"\nsamples_per_second = 4500\n",
     "1000000", "", "at 1000000 baud, which picolo run finds"},
};

/// Puts the driver's name into each section of the settings.
std::string configuration(const Vehicle& vehicle) {
  std::string text = vehicle.settings;
  for (const auto& [section, name] : {std::pair{"[wheels]\n", vehicle.wheels},
                                      {"[lidar]\n", vehicle.lidar},
                                      {"[imu]\n", vehicle.imu}}) {
    const std::string line = "driver = \"" + name + "\"\n";
    const std::size_t at = text.find(section);
    if (at == std::string::npos) {
      text += section + line;
    } else {
      text.insert(at + std::string{section}.size(), line);
    }
  }
  return text;
}

bool eventually(const std::function<bool()>& condition) {
  for (int i = 0; i < 800; ++i) {
    if (condition()) { return true; }
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  return false;
}

class LiveDevices : public ::testing::TestWithParam<Vehicle> {};

TEST_P(LiveDevices, SimulatedSeenByTheDoctorDrivenAndReplayed) {
  const Vehicle& vehicle = GetParam();
  const TemporaryFolder folder;
  folder.write("vehicle.toml", configuration(vehicle));
  folder.write("wheels.dbc",
               "BO_ 517 ANGLE: 8 X\n SG_ LEFT : 7|16@0+ (1,0) [0|16384] \"\" X\n"
               " SG_ RIGHT : 23|16@0+ (1,0) [0|16384] \"\" X\n");
  std::vector<std::string> simulation{"simulate",     "--can",     "socket:bus", "--lidar-pty",
                                      "lidar",        "--imu-pty", "imu",        "--config",
                                      "vehicle.toml", "--stand",   "60"};
  if (!vehicle.lidar_baud.empty()) {
    simulation.insert(simulation.end(), {"--lidar-baud", vehicle.lidar_baud});
  }
  if (!vehicle.imu_baud.empty()) {
    simulation.insert(simulation.end(), {"--imu-baud", vehicle.imu_baud});
  }
  Process simulate{folder, "simulate", simulation};
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(folder.path() / "imu"); }))
      << simulate.err();
  const test::ToolRun doctor =
      run_tool(folder, {"doctor", "--can", "socket:bus", "--lidar", "lidar", "--imu", "imu",
                        "--config", "vehicle.toml"});
  EXPECT_EQ(doctor.exit_code, 0) << doctor.out << doctor.err;
  EXPECT_THAT(doctor.out, HasSubstr(vehicle.finds));

  Process run{folder,
              "run",
              {"run", "--can", "socket:bus", "--lidar", "lidar", "--imu", "imu", "--config",
               "vehicle.toml", "--record", "rec", "--json"}};
  EXPECT_TRUE(eventually([&] { return run.err().find("-> tracking") != std::string::npos; }))
      << run.err() << simulate.err();
  std::this_thread::sleep_for(std::chrono::seconds{1});
  EXPECT_EQ(run.stop(SIGINT), 0) << run.err();
  EXPECT_EQ(simulate.stop(SIGTERM), 0) << simulate.err();
  for (const std::string& baud : {vehicle.lidar_baud, vehicle.imu_baud}) {
    if (!baud.empty()) { EXPECT_THAT(run.err(), HasSubstr("speaks at " + baud)); }
  }
  const host::Json json = host::Json::parse(run.out());
  EXPECT_GT(json.at("ticks"), 50);
  EXPECT_GT(json.at("imu_samples"), 50);
  EXPECT_GT(json.at("matched"), 3);
  std::printf("%s %s %s: %s\n", vehicle.wheels.c_str(), vehicle.lidar.c_str(), vehicle.imu.c_str(),
              run.out().c_str());

  const test::ToolRun replay = run_tool(folder, {"replay", "rec", "--out", "again", "--json"});
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_EQ(replay.json().at("pose_hash"), json.at("pose_hash"));
}

INSTANTIATE_TEST_SUITE_P(EveryDevice, LiveDevices, ::testing::ValuesIn(kVehicles));

TEST(LiveDevicesList, NoDeviceOfTheRegistryIsLeftOut) {
  std::set<std::string> driven;
  for (const Vehicle& vehicle : kVehicles) {
    driven.insert({vehicle.wheels, vehicle.lidar, vehicle.imu});
  }
  for (const devices::DeviceInfo& device : devices::all_devices()) {
    EXPECT_EQ(driven.count(device.name), 1U) << device.name;
  }
}

}  // namespace
}  // namespace picolo
