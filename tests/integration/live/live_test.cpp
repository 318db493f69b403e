// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The simulated vehicle and the controller as two processes in real time. The machine may be slow:
// nothing here asks for speed.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "tool_run.hpp"

namespace picolo {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

/// A picolo process in the background, with its output in a file.
class Process {
 public:
  Process(const TemporaryFolder& folder, const std::string& name,
          const std::vector<std::string>& arguments)
      : name_(folder.file(name)) {
    std::string line =
        "cd " + test::quoted(folder.path().string()) + " && exec " + test::quoted(PICOLO_TOOL);
    for (const std::string& argument : arguments) { line += " " + test::quoted(argument); }
    line += " >" + test::quoted(name_ + ".out") + " 2>" + test::quoted(name_ + ".err");
    pid_ = ::fork();
    if (pid_ == 0) {
      ::execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    }
  }
  ~Process() { stop(SIGKILL); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  /// Exit code; -1 when a signal ended it.
  int stop(int signal) {
    if (pid_ <= 0) { return -1; }
    ::kill(pid_, signal);
    return wait();
  }
  int wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string out() const { return test::content_of(name_ + ".out"); }
  [[nodiscard]] std::string err() const { return test::content_of(name_ + ".err"); }

 private:
  std::string name_;
  pid_t pid_ = -1;
};

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
