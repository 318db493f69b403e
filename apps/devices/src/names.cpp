// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/devices/registry.hpp"

namespace picolo::inline v0::devices {

const std::vector<DeviceInfo>& all_devices() {
  static const std::vector<DeviceInfo> kDevices{
      {Kind::wheels, "canopen", "CANopen drives (CiA 402) and encoders", {}},
      {Kind::lidar, "ld06", "LDROBOT LD06, LD19, STL-19P", {230'400}},
      {Kind::lidar,
       "rplidar",
       "Slamtec RPLIDAR A, S and C series",
       {115'200, 256'000, 460'800, 1'000'000}},
      {Kind::lidar, "scip", "Hokuyo URG, UTM, UST (SCIP 2.0)", {115'200, 19'200, 750'000}},
      {Kind::lidar,
       "ydlidar",
       "YDLIDAR X2, X4, G4, TX, T-mini",
       {128'000, 115'200, 230'400, 512'000}},
      {Kind::imu,
       "witmotion",
       "WitMotion WT901, JY901, HWT905",
       {115'200, 9'600, 230'400, 921'600},
       true},
  };
  return kDevices;
}

const DeviceInfo* find_device(Kind kind, const std::string& name) {
  for (const DeviceInfo& device : all_devices()) {
    if (device.kind == kind && device.name == name) { return &device; }
  }
  return nullptr;
}

std::string device_names(Kind kind) {
  std::string names;
  for (const DeviceInfo& device : all_devices()) {
    if (device.kind != kind) { continue; }
    names += (names.empty() ? "" : ", ") + device.name;
  }
  return names;
}

}  // namespace picolo::inline v0::devices
