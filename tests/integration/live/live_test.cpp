// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The simulated vehicle and the controller as two processes in real time. The machine may be slow:
// nothing here asks for speed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include "process.hpp"

namespace picolo {
namespace {

using test::Process;
using test::TemporaryFolder;
using ::testing::HasSubstr;

bool eventually(const std::function<bool()>& condition) {
  for (int i = 0; i < 600; ++i) {
    if (condition()) { return true; }
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  return false;
}

TEST(Live, TwoProcessesDriveUnplugAndReplayBitForBit) {
  const TemporaryFolder folder;
  Process simulate{folder,
                   "simulate",
                   {"simulate", "--can", "socket:bus", "--lidar-pty", "lidar", "--imu-pty", "imu",
                    "--wait", "--stand", "30", "--unplug", "lidar:5:1"}};
  Process run{folder,
              "run",
              {"run", "--can", "socket:bus", "--lidar", "lidar", "--imu", "imu", "--record", "rec",
               "--json"}};
  EXPECT_TRUE(eventually([&] {
    const std::string err = run.err();
    const std::size_t lost = err.find("(lidar_silent)");
    return lost != std::string::npos && err.find("-> tracking", lost) != std::string::npos;
  })) << run.err()
      << simulate.err();
  EXPECT_EQ(run.stop(SIGINT), 0) << run.err();
  EXPECT_EQ(simulate.stop(SIGTERM), 0) << simulate.err();
  const host::Json json = host::Json::parse(run.out());
  EXPECT_GT(json.at("ticks"), 100);
  EXPECT_GT(json.at("imu_samples"), 100);
  EXPECT_GT(json.at("matched"), 10);
  EXPECT_GT(json.at("frames_sent"), 100);

  const test::ToolRun replay = run_tool(folder, {"replay", "rec", "--out", "again", "--json"});
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_EQ(replay.json().at("pose_hash"), json.at("pose_hash"));
  EXPECT_TRUE(replay.json().at("same"));
}

TEST(Live, RunWaitsForDevicesAndEndsOnSigterm) {
  const TemporaryFolder folder;
  Process run{folder, "run", {"run", "--can", "socket:bus", "--lidar", "lidar", "--imu", "imu"}};
  EXPECT_TRUE(eventually([&] { return run.out().find("initialising") != std::string::npos; }))
      << run.err();
  EXPECT_THAT(run.err(), HasSubstr("waiting for it"));
  EXPECT_EQ(run.stop(SIGTERM), 0);
  EXPECT_THAT(run.out(), HasSubstr("cycles"));
}

TEST(Live, WrongUsageIsToldAtOnce) {
  const TemporaryFolder folder;
  folder.write("bad.toml", "[lidar]\ndriver = \"sonar\"\n");
  const test::ToolRun driver = run_tool(
      folder, {"run", "--can", "socket:bus", "--lidar", "l", "--imu", "i", "--config", "bad.toml"});
  EXPECT_EQ(driver.exit_code, 2);
  EXPECT_THAT(driver.err, HasSubstr("ld06"));
  folder.write("overlap.toml", "[can]\nbase_id = 384\n");
  const test::ToolRun overlap = run_tool(folder, {"run", "--can", "socket:bus", "--lidar", "l",
                                                  "--imu", "i", "--config", "overlap.toml"});
  EXPECT_EQ(overlap.exit_code, 2);
  EXPECT_THAT(overlap.err, HasSubstr("identifier 0x181 is used by [wheels] canopen and by"));
  const test::ToolRun imu = run_tool(folder, {"run", "--can", "socket:bus", "--lidar", "l"});
  EXPECT_EQ(imu.exit_code, 2);
  EXPECT_THAT(imu.err, HasSubstr("present = false"));
  const test::ToolRun unplug = run_tool(
      folder, {"simulate", "--can", "socket:bus", "--lidar-pty", "l", "--unplug", "wheels:1"});
  EXPECT_EQ(unplug.exit_code, 2);
  folder.write("file", "");
  const test::ToolRun link =
      run_tool(folder, {"simulate", "--can", "socket:bus", "--lidar-pty", "file"});
  EXPECT_EQ(link.exit_code, 2);
  EXPECT_THAT(link.err, HasSubstr("is no link"));
}

}  // namespace
}  // namespace picolo
