// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/devices/registry.hpp"
#include "picolo/drivers/common/can_overlap.hpp"

namespace picolo::inline v0::devices {

const std::vector<DeviceInfo>& all_devices() {
  static const std::vector<DeviceInfo> kDevices{
      {Kind::wheels, "canopen", "CANopen drives (CiA 402) and encoders", {}},
      {Kind::wheels, "odrive", "ODrive, CANSimple protocol", {}},
      {Kind::wheels, "vesc", "VESC status frames", {}},
      {Kind::wheels, "dbc", "signals of any CAN database (DBC file)", {}},
      {Kind::lidar, "ld06", "LDROBOT LD06, LD19, STL-19P", {230'400}},
      {Kind::lidar,
       "rplidar",
       "Slamtec RPLIDAR A, S and C series",
       {115'200, 256'000, 460'800, 1'000'000},
       false,
       false,
       true},
      {Kind::lidar,
       "scip",
       "Hokuyo URG, UTM, UST (SCIP 2.0)",
       {115'200, 19'200, 750'000},
       false,
       true,
       true},
      {Kind::lidar,
       "ydlidar",
       "YDLIDAR X2, X4, G4, TX, T-mini",
       {128'000, 115'200, 230'400, 512'000},
       false,
       true,
       true},
      {Kind::imu,
       "witmotion",
       "WitMotion WT901, JY901, HWT905",
       {115'200, 9'600, 230'400, 921'600},
       true},
      {Kind::imu, "bno08x-rvc", "BNO080, BNO085, BNO086 in UART-RVC mode", {115'200}, true},
      {Kind::imu, "xsens", "Xsens MTi (MTData2)", {115'200, 921'600, 2'000'000}, true},
      {Kind::imu,
       "vectornav",
       "VectorNav VN-100, VN-200, VN-300",
       {115'200, 921'600, 230'400},
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

std::string describe_overlap(const std::vector<BusUser>& users) {
  std::vector<CanListener> listeners;
  for (const BusUser& user : users) { listeners.push_back({user.name.c_str(), user.filters}); }
  const Result<CanOverlap> found = find_overlap(listeners);
  if (!found) { return {}; }
  constexpr const char* kDigits = "0123456789ABCDEF";
  std::string id;
  for (int shift = found->filter.extended ? 28 : 8; shift >= 0; shift -= 4) {
    id += kDigits[(found->filter.id >> static_cast<unsigned>(shift)) & 0xFU];
  }
  return "identifier 0x" + id + " is used by " + found->first + " and by " + found->second +
         "; give one of them another node";
}

}  // namespace picolo::inline v0::devices
