// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The cycle calls nothing of the C library that may wait: no heap, no lock, no sleep, no file.
// RealtimeSanitizer's runtime ends the program at the first such call between enter and exit.

#include <gtest/gtest.h>

#include <cstdlib>
#include <ctime>
#include <memory>
#include <mutex>
#include <vector>

#include "picolo/controller/onboard_calibration.hpp"
#include "picolo/controller/stored_maps.hpp"
#include "picolo/sim/sim_byte_store.hpp"
#include "support/wired_drive.hpp"

// The sanitizer's interface (compiler-rt/lib/rtsan/rtsan.h).
extern "C" {
void __rtsan_init();            // NOLINT
void __rtsan_realtime_enter();  // NOLINT
void __rtsan_realtime_exit();   // NOLINT
}

namespace picolo {
namespace {

class RealtimeScope {
 public:
  RealtimeScope() { __rtsan_realtime_enter(); }
  ~RealtimeScope() { __rtsan_realtime_exit(); }
  RealtimeScope(const RealtimeScope&) = delete;
  RealtimeScope& operator=(const RealtimeScope&) = delete;
};

template <typename Work>
auto in_real_time(Work&& work) {
  const RealtimeScope scope;
  return work();
}

struct Realtime : ::testing::Test {
  static void SetUpTestSuite() { __rtsan_init(); }
};

// Every part of the cycle: tracking, mapping, a map saved and loaded, commands, and a calibration
// from its first standstill to its stored record.
TEST_F(Realtime, GivenADriveWithEveryServiceThenTheCycleCallsNothingThatMayWait) {
  std::vector<std::uint8_t> memory(512 * 1024);
  sim::SimByteStore flash{memory, 4096, 8};
  CalibrationStore records{flash};
  StoredMaps maps{flash, {.address = 2 * 4096}};
  auto calibration = std::make_unique<OnboardCalibration<360>>(
      onboard_calibration(simulated_vehicle_config()), &records);
  auto drive = std::make_unique<test::WiredDrive>(
      ControllerServices{.maps = &maps, .calibration = &calibration->core()});
  PoseEstimate seen;
  const auto until = [&](Duration elapsed) {
    drive->until(elapsed, [&seen](auto& controller) {
      return in_real_time([&] {
        const Status status = controller.run_frame();
        return controller.read_pose(seen) ? status : Status::not_ready;
      });
    });
  };
  until(1s);
  drive->send(CommandKind::start_calibration, kCalibrateAll);
  until(20s);
  drive->send(CommandKind::save_map, 0);
  until(150s);
  if (calibration->core().routine().phase() == CalibrationPhase::collecting) {
    drive->send(CommandKind::start_calibration, kFinishCalibration);
  }
  until(170s);
  EXPECT_EQ(calibration->core().routine().phase(), CalibrationPhase::done);
  CalibrationRecord record;
  EXPECT_EQ(records.load(record), Status::ok);
  drive->send(CommandKind::load_map, 0);
  until(180s);
  EXPECT_TRUE(drive->robot.controller().pipeline().localiser().localises_only()) << "loaded";
  EXPECT_EQ(drive->robot.controller().commands().counters().refused, 0U);
  EXPECT_GT(seen.matches, 1500U);
}

// A control: what may stand in real time does not end the program.
TEST_F(Realtime, WhatDoesNotWaitPasses) {
  volatile int sum = 0;
  in_real_time([&] {
    for (int i = 0; i < 1000; ++i) { sum = sum + i; }
  });
  EXPECT_EQ(sum, 499'500);
}

using RealtimeDeathTest = Realtime;

TEST_F(RealtimeDeathTest, HeapIsTrapped) {
  EXPECT_DEATH(in_real_time([] {
                 void* volatile block = std::malloc(16);
                 std::free(block);
               }),
               "unsafe function `malloc`");
  EXPECT_DEATH(in_real_time([] { return std::make_unique<std::vector<int>>(9)->size(); }),
               "unsafe function `");
}

TEST_F(RealtimeDeathTest, ALockIsTrapped) {
  std::mutex mutex;
  EXPECT_DEATH(in_real_time([&mutex] { const std::lock_guard guard{mutex}; }),
               "unsafe function `pthread_mutex_lock`");
}

TEST_F(RealtimeDeathTest, SleepIsTrapped) {
  EXPECT_DEATH(in_real_time([] {
                 const timespec shortly{.tv_sec = 0, .tv_nsec = 1};
                 return nanosleep(&shortly, nullptr);
               }),
               "unsafe function `nanosleep`");
}

TEST_F(RealtimeDeathTest, ACycleThatAllocatesIsTrapped) {
  // One level down: a map service, called by the background task, that takes memory.
  struct Careless final : MapService {
    Status begin_save(std::uint8_t, LocaliserCore&) override {
      kept.push_back(1);
      return Status::ok;
    }
    Status begin_load(std::uint8_t, LocaliserCore&) override { return Status::unsupported; }
    Status step(LocaliserCore&) override { return Status::ok; }
    std::vector<int> kept;
  };
  Careless maps;
  auto drive = std::make_unique<test::WiredDrive>(ControllerServices{.maps = &maps});
  drive->until(1s);
  drive->send(CommandKind::save_map, 0);
  EXPECT_DEATH(drive->until(2s,
                            [](auto& controller) {
                              return in_real_time([&] { return controller.run_frame(); });
                            }),
               "unsafe function `malloc`");
}

}  // namespace
}  // namespace picolo
