// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The one failure that must not happen: a pose that is wrong by more than 0.20 m or 3 degrees while
// the state says tracking, for three publications in a row. Every kind of fault on every device for
// three seconds of a drive through the office.

#include <gtest/gtest.h>

#include <string>
#include <tuple>

#include "drive.hpp"

namespace picolo {
namespace {

using sim::Device;
using sim::FaultKind;

class FaultMatrix : public ::testing::TestWithParam<std::tuple<Device, FaultKind, std::uint64_t>> {
};

TEST_P(FaultMatrix, NoSilentWrongPose) {
  const auto [device, kind, seed] = GetParam();
  const Duration begin =
      10s + static_cast<std::int64_t>(seed) * 1370ms;  // elsewhere on the route each time
  sim::SimulationConfig simulation = test::drive_in(sim::SceneName::office, {{.device = device,
                                                                              .kind = kind,
                                                                              .begin = begin,
                                                                              .end = begin + 3s,
                                                                              .probability = 0.3F,
                                                                              .delay = 30ms}});
  simulation.seed = seed;
  test::Drive drive{simulation};
  drive.until(begin);
  ASSERT_EQ(drive.state(), HealthState::tracking);
  drive.until(begin + 15s);
  EXPECT_EQ(drive.silent_wrong(), 0);
}

std::string name_of(Device device) {
  constexpr std::array<const char*, sim::kDevices> kNames{"wheel_left", "wheel_right", "lidar",
                                                          "imu", "can_bus"};
  return kNames[static_cast<std::size_t>(device)];
}

std::string name_of(FaultKind kind) {
  constexpr std::array<const char*, sim::kFaultKinds> kNames{
      "drop", "corrupt", "delay", "duplicate", "silence", "freeze", "disconnect"};
  return kNames[static_cast<std::size_t>(kind)];
}

INSTANTIATE_TEST_SUITE_P(
    Office, FaultMatrix,
    ::testing::Combine(::testing::Values(Device::wheel_left, Device::wheel_right, Device::lidar,
                                         Device::imu, Device::can_bus),
                       ::testing::Values(FaultKind::drop, FaultKind::corrupt, FaultKind::delay,
                                         FaultKind::duplicate, FaultKind::silence,
                                         FaultKind::freeze, FaultKind::disconnect),
                       ::testing::Values(std::uint64_t{2}, std::uint64_t{3})),
    [](const auto& fault_info) {
      return name_of(std::get<0>(fault_info.param)) + "_" + name_of(std::get<1>(fault_info.param)) +
             "_" + std::to_string(std::get<2>(fault_info.param));
    });

}  // namespace
}  // namespace picolo
