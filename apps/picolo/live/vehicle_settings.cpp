// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/vehicle_settings.hpp"

#include <limits>

#include "picolo/controller/command_desk.hpp"
#include "picolo/host/config_file.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/library_config.hpp"
#include "picolo/simulated/simulated_controller.hpp"

namespace picolo::tool {
namespace {

using host::ConfigFile;
using host::ExitCode;
using host::UserError;

// Without a real-time scheduler a frame is late now and then; that is no reason to doubt a pose.
constexpr std::uint32_t kToleratedSlips = 40;

// Of a computer, not of a microcontroller: some 4 million instructions for 450 returns.
constexpr std::uint32_t kSearchSlices = 32;
constexpr std::uint32_t kMostSearchSlices = 1024;

template <typename Integer>
void read_count(ConfigFile& file, const std::string& section, const std::string& key,
                Integer& value) {
  int wide = static_cast<int>(value);
  file.read(section, key, wide);
  if (wide < 0 || static_cast<std::uint64_t>(wide) > std::numeric_limits<Integer>::max()) {
    throw UserError{
        ExitCode::usage, "", "[" + section + "] " + key + " is out of range",
        "give a number from 0 to " + std::to_string(std::numeric_limits<Integer>::max())};
  }
  value = static_cast<Integer>(wide);
}

/// The driver's name and the rates of its line.
void read_device(ConfigFile& file, devices::Kind kind, const std::string& section,
                 std::string& name, std::vector<std::uint32_t>* bauds) {
  file.read(section, "driver", name);
  const devices::DeviceInfo* device = devices::find_device(kind, name);
  if (device == nullptr) {
    throw UserError{ExitCode::usage, "", "[" + section + "] driver: there is no '" + name + "'",
                    "give one of " + devices::device_names(kind)};
  }
  if (bauds == nullptr) { return; }
  std::uint32_t baud = 0;
  read_count(file, section, "baud", baud);
  *bauds = baud == 0 ? device->bauds : std::vector{baud};
}

void read_duration(ConfigFile& file, const std::string& section, const std::string& key,
                   Duration& duration) {
  double milliseconds = 1e3 * to_seconds_f64(duration);
  file.read(section, key, milliseconds);
  duration = from_seconds(1e-3 * milliseconds);
}

void read_wheels(ConfigFile& file, VehicleSettings& settings) {
  DifferentialDriveConfig& drive = settings.controller.drive;
  file.read("vehicle", "left_radius_m", drive.left_radius_m);
  file.read("vehicle", "right_radius_m", drive.right_radius_m);
  file.read("vehicle", "track_m", drive.track_m);
  file.read("vehicle", "counts_per_revolution", drive.counts_per_revolution);
  file.read("vehicle", "max_wheel_speed_mps", settings.controller.plausibility.max_wheel_speed_mps);
  read_device(file, devices::Kind::wheels, "wheels", settings.wheels_name, nullptr);
  devices::WheelsSettings& wheels = settings.wheels;
  read_count(file, "wheels", "left_id", wheels.left_id);
  read_count(file, "wheels", "right_id", wheels.right_id);
  file.read("wheels", "left_inverted", wheels.left_inverted);
  file.read("wheels", "right_inverted", wheels.right_inverted);
  file.read("wheels", "produce_sync", wheels.produce_sync);
  file.read("wheels", "set_up_nodes", wheels.set_up_nodes);
  read_count(file, "wheels", "pole_pairs", wheels.pole_pairs);
  read_count(file, "wheels", "counts_per_turn", wheels.counts_per_turn);
  file.read("wheels", "dbc_file", wheels.dbc_file);
  file.read("wheels", "left_signal", wheels.left_signal);
  file.read("wheels", "right_signal", wheels.right_signal);
  file.read("wheels", "speed_ticks_per_unit", wheels.speed_ticks_per_unit);
}

void read_sensors(ConfigFile& file, VehicleSettings& settings) {
  UndistortConfig& lidar = settings.controller.undistort;
  file.read("lidar", "x_m", lidar.base_T_lidar.x_m);
  file.read("lidar", "y_m", lidar.base_T_lidar.y_m);
  file.read("lidar", "yaw_rad", lidar.base_T_lidar.theta_rad);
  file.read("lidar", "min_range_m", lidar.limits.min_m);
  file.read("lidar", "max_range_m", lidar.limits.max_m);
  read_device(file, devices::Kind::lidar, "lidar", settings.lidar_name, &settings.lidar_bauds);
  file.read("lidar", "mode", settings.lidar.mode);
  read_count(file, "lidar", "samples_per_second", settings.lidar.samples_per_second);
  read_count(file, "lidar", "motor_pwm", settings.lidar.motor_pwm);
  read_count(file, "lidar", "motor_rpm", settings.lidar.motor_rpm);
  read_device(file, devices::Kind::imu, "imu", settings.imu_name, &settings.imu_bauds);
  read_count(file, "imu", "rate_full_scale_degps", settings.imu.rate_full_scale_degps);
  read_count(file, "imu", "acceleration_full_scale_g", settings.imu.acceleration_full_scale_g);
  bool present = settings.controller.health.expects_gyro;
  file.read("imu", "present", present);
  settings.controller.health.expects_gyro = present;
  settings.controller.dead_reckoning.use_gyro = present;
  file.read("imu", "gyro_sign", settings.controller.dead_reckoning.gyro_sign);
}

void read_cycle(ConfigFile& file, VehicleSettings& settings) {
  ControllerConfig& controller = settings.controller;
  int base_id = controller.frames_out.base_id;
  file.read("can", "base_id", base_id);
  file.read("can", "frames_out", controller.frames_out.enabled);
  controller.frames_out.base_id = static_cast<std::uint16_t>(base_id & 0xFFFF);
  read_duration(file, "cycle", "minor_frame_ms", controller.cycle.minor_frame);
  read_duration(file, "cycle", "major_frame_ms", controller.cycle.major_frame);
  read_count(file, "cycle", "tolerated_overruns", controller.health.tolerated_overruns);
  std::uint32_t& slices = controller.work.max_search_slices;
  read_count(file, "cycle", "search_slices", slices);
  if (slices == 0 || slices > kMostSearchSlices) {
    throw UserError{ExitCode::usage, "", "[cycle] search_slices is out of range",
                    "give a number from 1 to " + std::to_string(kMostSearchSlices)};
  }
}

}  // namespace

VehicleSettings::VehicleSettings() : controller(simulated_vehicle_config()) {
  const sim::WheelPairConfig pair;
  wheels.left_id = pair.left.node;
  wheels.right_id = pair.right.node;
  wheels.produce_sync = true;
  controller.health.tolerated_overruns = kToleratedSlips;
  controller.work.max_search_slices = kSearchSlices;
}

VehicleSettings read_vehicle(const std::string& path) {
  VehicleSettings settings;
  ConfigFile file{path};
  file.read("vehicle", "profile", settings.profile);
  read_wheels(file, settings);
  read_sensors(file, settings);
  read_cycle(file, settings);
  read(file, "localiser", settings.controller.localiser);
  file.reject_unknown({"demo", "replay", "undistort"});
  if (!settings.controller.valid()) {
    throw UserError{
        ExitCode::usage, path, "the settings of the vehicle do not fit together",
        "check sizes and counts (positive), ranges (min < max), [can] base_id (a multiple of 16), "
        "[cycle] (the major frame is a multiple of five minor ones)"};
  }
  return settings;
}

std::string overlap_of(const VehicleSettings& settings, const std::vector<CanFilter>& wheels) {
  const auto own = command_filters(settings.controller.frames_out);
  return devices::describe_overlap({{"[wheels] " + settings.wheels_name, wheels},
                                    {"picolo's own frames", {own.begin(), own.end()}}});
}

}  // namespace picolo::tool
