// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "support/data.hpp"
#include "tool_run.hpp"

namespace picolo {
namespace {

using test::run_tool;
using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kRate_radps = 1.5;

/// A vehicle that turns on the spot at (1.02, 2) between two walls at x = 0.02 and x = 5.02, lidar
/// in its middle, 20 sweeps of 0.1 s and 200 beams; odometry at 50 Hz.
std::string turning_drive() {
  std::string text;
  const auto yaw_at = [](double t) { return kRate_radps * t; };
  for (int k = 0; k <= 110; ++k) {
    const double t = 0.02 * k;
    text += fmt::format("ODOM 1.02 2 {:.7f} 0 {} 0 {:.6f} host {:.6f}\n",
                        std::remainder(yaw_at(t), 2.0 * std::numbers::pi), kRate_radps, t, t);
  }
  for (int sweep = 0; sweep < 20; ++sweep) {
    const double start = 0.05 + 0.1 * sweep;
    text += fmt::format("SWEEP {:.6f} 0.0005 200 {:.6f}", start, start + 0.2);
    for (int beam = 0; beam < 200; ++beam) {
      const double bearing = 2.0 * std::numbers::pi * beam / 200.0 - std::numbers::pi;
      const double along = std::cos(yaw_at(start + 0.0005 * beam) + bearing);
      const double range = along > 0.5 ? 4.0 / along : along < -0.2 ? -1.0 / along : 0.0;
      text += fmt::format(" {:.6f} {:.4f}", bearing, range);
    }
    text += "\n";
  }
  return text;
}

std::vector<std::string> undistort(const std::string& file) {
  return {"undistort", file, "--json", "--lidar", "0", "0", "0", "--cell", "0.04"};
}

TEST(Undistort, TurningDriveBetweenWallsBecomesSharp) {
  const TemporaryFolder folder;
  const test::ToolRun run = run_tool(folder, undistort(folder.write("a.log", turning_drive())));
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty()) << "no progress without a terminal";
  const host::Json json = run.json();
  EXPECT_EQ(json["sweeps_counted"], 20);
  EXPECT_GT(json["returns_counted"].get<int>(), 2000);
  EXPECT_LT(json["cells_after"].get<int>(), json["cells_before"].get<int>() / 2);
  for (const char* name : {"before.png", "before.svg", "after.png", "after.svg"}) {
    EXPECT_GT(std::filesystem::file_size(folder.path() / "picolo-out" / name), 1000U) << name;
  }
}

TEST(Undistort, PlainGzAndPipeGiveTheSame) {
  const TemporaryFolder folder;
  const std::string text = turning_drive();
  const auto plain = run_tool(folder, undistort(folder.write("a.log", text)));
  const auto packed = run_tool(folder, undistort(folder.write_gz("a.log.gz", text)));
  const auto piped = run_tool(folder, undistort("-"), folder.file("a.log.gz"));
  EXPECT_EQ(plain.exit_code, 0);
  EXPECT_EQ(plain.out, packed.out);
  EXPECT_EQ(plain.out, piped.out) << piped.err;
}

TEST(Undistort, ABadLineIsSkippedWithFileAndLine) {
  const TemporaryFolder folder;
  const test::ToolRun run =
      run_tool(folder, undistort(folder.write("a.log", "SWEEP 1 2 x 4\n" + turning_drive())));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("a.log:1: "));
  EXPECT_EQ(run.json()["sweeps_counted"], 20);
}

TEST(Undistort, ATruncatedGzKeepsWhatWasReadAndExits3) {
  const TemporaryFolder folder;
  const std::string packed = test::content_of(folder.write_gz("whole.gz", turning_drive()));
  const test::ToolRun run =
      run_tool(folder, undistort(folder.write("cut.gz", packed.substr(0, packed.size() * 3 / 4))));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("cut.gz: the compressed file ends too early"));
  EXPECT_GT(run.json()["sweeps_counted"].get<int>(), 5);
  EXPECT_LT(run.json()["sweeps_counted"].get<int>(), 20);
}

TEST(Undistort, ASlowDriveIsRefused) {
  const TemporaryFolder folder;
  auto arguments = undistort(folder.write("a.log", turning_drive()));
  arguments.insert(arguments.end(), {"--min-yaw-rate", "2"});
  const test::ToolRun run = run_tool(folder, arguments);
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("--min-yaw-rate"));
}

TEST(Undistort, SettingsComeFromTheConfigFileAndOptionsWin) {
  const TemporaryFolder folder;
  const std::string drive = folder.write("a.log", turning_drive());
  const std::string config =
      folder.write("c.toml", "[undistort]\nlidar_x_m = 0.0\nlidar_yaw_rad = 0.0\ncell_m = 0.04\n");
  const auto by_file = run_tool(folder, {"undistort", drive, "--json", "--config", config});
  const auto by_options = run_tool(folder, undistort(drive));
  EXPECT_EQ(by_file.out, by_options.out) << by_file.err;
  const auto coarser =
      run_tool(folder, {"undistort", drive, "--json", "--config", config, "--cell", "0.4"});
  EXPECT_LT(coarser.json()["cells_after"].get<int>(), by_file.json()["cells_after"].get<int>());
  folder.write("c.toml", "[undistort]\ncel_m = 0.04\n");
  const auto misspelt = run_tool(folder, {"undistort", drive, "--json", "--config", config});
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("c.toml:2: unknown key 'undistort.cel_m'"));
}

TEST(Undistort, AnOutputFolderThatCannotBeIsWrongUsage) {
  const TemporaryFolder folder;
  auto arguments = undistort(folder.write("a.log", turning_drive()));
  arguments.insert(arguments.end(), {"--out", "a.log/below"});
  EXPECT_EQ(run_tool(folder, arguments).exit_code, 2);
}

TEST(Undistort, RecordedTurningRobotGivesThePublishedCounts) {
  PICOLO_NEED_DATA("imu/undistort_sweeps_a.txt.gz");
  const TemporaryFolder folder;
  const test::ToolRun run = run_tool(
      folder, {"undistort", test::data_path("imu/undistort_sweeps_a.txt.gz").string(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty());
  EXPECT_EQ(run.json()["sweeps_counted"], 275);
  EXPECT_EQ(run.json()["returns_counted"], 50603);
  EXPECT_EQ(run.json()["cells_before"], 3525);
  EXPECT_NEAR(run.json()["cells_after"].get<double>(), 1747.0, 5.0);
}

}  // namespace
}  // namespace picolo
