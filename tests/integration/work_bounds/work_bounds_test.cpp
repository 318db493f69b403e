// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The bounds of work for a Cortex-M4F: they fit its frame, and no sweep is left out.

#include <gtest/gtest.h>

#include <memory>

#include "picolo/simulated/board_config.hpp"
#include "picolo/simulated/trajectory_hash.hpp"
#include "support/wired_drive.hpp"
#include "work_model.hpp"

namespace picolo {
namespace {

/// The stages of a sweep that had work in a frame.
class StageWatch {
 public:
  void ran(std::size_t /*task*/, std::uint32_t /*cycles*/) {
    const Pipeline& pipeline = *watched;
    const bool moved = pipeline.stage() != stage_;
    stages_ += moved ? 1 : 0;
    stage_ = pipeline.stage();
  }
  void next_frame() {
    most = std::max(most, stages_);
    stages_ = 0;
  }
  const Pipeline* watched = nullptr;
  int most = 0;

 private:
  PipelineStage stage_ = PipelineStage::waiting;
  int stages_ = 0;
};

struct DriveEnd {
  std::uint32_t matches = 0;
  std::uint32_t replaced = 0;
  int most_stages = 0;
};

DriveEnd drive_with(ControllerConfig config) {
  config.frames_out.enabled = false;  // they move the stamps of the wheels on the bus
  const auto robot = std::make_unique<SimulatedController<RoomProfile>>(
      hashed_drive(sim::SceneName::office), config);
  StageWatch watch;
  watch.watched = &robot->controller().pipeline();
  EXPECT_EQ(robot->start(), Status::ok);
  const Pipeline& pipeline = robot->controller().pipeline();
  constexpr std::uint32_t kSweeps = 90;
  while (robot->simulation().now() < Timestamp{} + 12s &&
         (pipeline.localiser().counters().inserted < kSweeps ||
          pipeline.stage() == PipelineStage::mapping)) {
    EXPECT_EQ(robot->run_frame(watch), Status::ok);
    watch.next_frame();
  }
  return {pipeline.localiser().counters().matched,
          pipeline.counters().sweeps_replaced + pipeline.sweep_counters().replaced, watch.most};
}

TEST(WorkBounds, OfACortexM4FLeaveNoSweepOutOneStageAFrame) {
  const DriveEnd usual = drive_with(board_config(false));
  const DriveEnd bounded = drive_with(board_config(true));
  EXPECT_EQ(bounded.matches, usual.matches);
  EXPECT_EQ(bounded.replaced, 0U);
  EXPECT_GT(usual.most_stages, 1);
  EXPECT_EQ(bounded.most_stages, 1);
}

TEST(WorkBounds, OfACortexM4FLetACalibrationComeToItsEnd) {
  const ControllerConfig config = board_config(true);
  const auto calibration = std::make_unique<BoardCalibration>(board_calibration(config, true));
  const auto run = std::make_unique<test::WiredDrive>(
      ControllerServices{.calibration = &calibration->core()}, config);
  run->until(1s);
  run->send(CommandKind::start_calibration, kCalibrateAll);
  run->until(95s);
  run->send(CommandKind::start_calibration, kFinishCalibration);
  run->until(110s);
  const CalibrationRoutine& routine = calibration->core().routine();
  EXPECT_EQ(routine.phase(), CalibrationPhase::done)
      << to_string(routine.refusal().parameter) << ": " << to_string(routine.refusal().reason)
      << ", " << routine.report().used << " samples, " << routine.scans() << " scans, "
      << routine.scans_dropped() << " dropped";
}

TEST(WorkBounds, OfACortexM4FFitIntoItsFrameAt168MHz) {
  constexpr double kInstructionsPerUs = 168.0;
  const ControllerConfig config = board_config(true);
  ASSERT_TRUE(config.valid());
  const auto declared = target::declared_budgets(target::kCortexM4F, config);
  const auto fits = [&](const char* row, Duration budget) {
    const double limit = kInstructionsPerUs * static_cast<double>(budget.count());
    EXPECT_LE(declared.at(row), limit) << row;
    EXPECT_LE(limit, 1.25 * declared.at(row)) << row << ": more time than it needs";
  };
  fits("can", config.budgets.can);
  fits("serial", config.budgets.serial);
  fits("odometry", config.budgets.odometry);
  fits("report", config.budgets.report);
  fits("background", config.budgets.background);
  const Duration stage = config.budgets.undistort;
  EXPECT_EQ(config.budgets.match, stage);
  EXPECT_EQ(config.budgets.map, stage);
  const double longest =
      std::max({declared.at("undistort"), declared.at("match"), declared.at("map")});
  EXPECT_LE(longest, kInstructionsPerUs * static_cast<double>(stage.count()));
}

}  // namespace
}  // namespace picolo
