// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The one failure that must not happen: a pose that is wrong by more than 0.20 m or 3 degrees while
// the state says tracking, for three publications in a row. Every kind of fault on every device for
// three seconds of a drive, at 20 instants and places, as a table: told (the state leaves tracking
// during the fault or while the pose is wrong because of it), borne (the pose stays true without a
// word), silent.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <tuple>
#include <vector>

#include "drive.hpp"

namespace picolo {
namespace {

using sim::Device;
using sim::FaultKind;

constexpr std::array<const char*, sim::kDevices> kDeviceNames{"wheel_left", "wheel_right", "lidar",
                                                              "imu", "can_bus"};
constexpr std::array<const char*, sim::kFaultKinds> kKindNames{
    "drop", "corrupt", "delay", "duplicate", "silence", "freeze", "disconnect"};

struct Judgement {
  bool told = false;
  Duration told_after{};  // since the fault began
  double worst_tracking_m = 0.0;
  int silent = 0;
};

Judgement drive_with(sim::SceneName scene, Device device, FaultKind kind, std::uint64_t seed) {
  const Duration begin = 10s + static_cast<std::int64_t>(seed) * 1370ms;  // elsewhere on the route
  sim::SimulationConfig simulation = test::drive_in(scene, {{.device = device,
                                                             .kind = kind,
                                                             .begin = begin,
                                                             .end = begin + 3s,
                                                             .probability = 0.3F,
                                                             .delay = 30ms}});
  simulation.seed = seed;
  test::Drive drive{simulation};
  drive.until(begin);
  EXPECT_EQ(drive.state(), HealthState::tracking);
  Judgement judgement;
  drive.until(begin + 12s, [&](const test::Publication& publication) {
    if (publication.estimate.state == HealthState::tracking) {
      judgement.worst_tracking_m =
          std::max(judgement.worst_tracking_m, publication.position_error_m);
    } else if (!judgement.told) {
      judgement.told = true;
      judgement.told_after = (publication.estimate.stamp - simulation.start) - begin;
    }
  });
  judgement.silent = drive.silent_wrong();
  return judgement;
}

class FaultMatrix : public ::testing::TestWithParam<std::tuple<Device, FaultKind>> {};

TEST_P(FaultMatrix, NoSilentWrongPoseInTwentyDrives) {
  const auto [device, kind] = GetParam();
  int told = 0;
  int silent = 0;
  double worst_m = 0.0;
  std::vector<Duration> delays;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const auto scene = seed % 2 == 0 ? sim::SceneName::office : sim::SceneName::room;
    const Judgement judgement = drive_with(scene, device, kind, seed);
    EXPECT_EQ(judgement.silent, 0) << "seed " << seed;
    silent += judgement.silent > 0 ? 1 : 0;
    worst_m = std::max(worst_m, judgement.worst_tracking_m);
    if (!judgement.told) { continue; }
    ++told;
    delays.push_back(judgement.told_after);
  }
  std::sort(delays.begin(), delays.end());
  const auto at = [&delays](std::size_t percent) {
    return delays.empty()
               ? 0.0
               : static_cast<double>(delays[(delays.size() - 1) * percent / 100].count()) * 1e-3;
  };
  std::printf(
      "| %-11s | %-10s | told %2d (median %5.0f ms, last %5.0f ms) | borne %2d | silent %d | "
      "worst while tracking %.2f m |\n",
      kDeviceNames[static_cast<std::size_t>(device)], kKindNames[static_cast<std::size_t>(kind)],
      told, at(50), at(100), 20 - told, silent, worst_m);
}

INSTANTIATE_TEST_SUITE_P(
    OfficeAndRoom, FaultMatrix,
    ::testing::Combine(::testing::Values(Device::wheel_left, Device::wheel_right, Device::lidar,
                                         Device::imu, Device::can_bus),
                       ::testing::Values(FaultKind::drop, FaultKind::corrupt, FaultKind::delay,
                                         FaultKind::duplicate, FaultKind::silence,
                                         FaultKind::freeze, FaultKind::disconnect)),
    [](const auto& fault_info) {
      return std::string{kDeviceNames[static_cast<std::size_t>(std::get<0>(fault_info.param))]} +
             "_" + kKindNames[static_cast<std::size_t>(std::get<1>(fault_info.param))];
    });

}  // namespace
}  // namespace picolo
