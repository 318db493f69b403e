// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// One line of a driving vehicle is pulled out: what that costs the machine. Counted, not timed: the
// kernel's counts of this process' wake-ups and reads; its processor time is printed.

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>

#include "process.hpp"

namespace picolo {
namespace {

using test::Process;
using Steady = std::chrono::steady_clock;

/// The number behind a name in a file of /proc; 0 where this kernel has none.
double proc_number(pid_t pid, const char* file, const std::string& name) {
  std::ifstream stream{"/proc/" + std::to_string(pid) + "/" + file};
  for (std::string word; stream >> word;) {
    double value = 0.0;
    if (word == name && stream >> value) { return value; }
  }
  return 0.0;
}

struct Work {
  double wake_ups = 0.0;
  double reads = 0.0;
  double processor_s = 0.0;
};

Work work_of(pid_t pid) {
  Work work{.wake_ups = proc_number(pid, "status", "voluntary_ctxt_switches:"),
            .reads = proc_number(pid, "io", "syscr:")};
  std::ifstream stat{"/proc/" + std::to_string(pid) + "/stat"};
  std::string skipped;
  for (int i = 0; i < 13; ++i) { stat >> skipped; }
  double user = 0.0;
  double system = 0.0;
  stat >> user >> system;
  work.processor_s = (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  return work;
}

/// A second of a process, on average over six.
Work work_a_second(pid_t pid) {
  const Work before = work_of(pid);
  const auto start = Steady::now();
  std::this_thread::sleep_for(std::chrono::seconds{6});
  const Work after = work_of(pid);
  const double seconds = std::chrono::duration<double>(Steady::now() - start).count();
  return {(after.wake_ups - before.wake_ups) / seconds, (after.reads - before.reads) / seconds,
          (after.processor_s - before.processor_s) / seconds};
}

bool eventually(const auto& condition) {
  for (int i = 0; i < 800; ++i) {
    if (condition()) { return true; }
    std::this_thread::sleep_for(std::chrono::milliseconds{50});
  }
  return false;
}

class UnpluggedLine : public ::testing::TestWithParam<const char*> {};

TEST_P(UnpluggedLine, CostsNoMoreThanItsDevice) {
  const test::TemporaryFolder folder;
  const std::string device = GetParam();
  Process simulate{folder,
                   "simulate",
                   {"simulate", "--can", "socket:bus", "--lidar-pty", "lidar", "--imu-pty", "imu",
                    "--wait", "--unplug", device + ":18:100"}};
  Process run{
      folder, "run", {"run", "--can", "socket:bus", "--lidar", "lidar", "--imu", "imu", "--quiet"}};
  ASSERT_TRUE(eventually([&] { return run.err().find("initialising ->") != std::string::npos; }))
      << run.err() << simulate.err();
  const Work whole = work_a_second(run.pid());
  ASSERT_EQ(simulate.err().find("unplugged"), std::string::npos) << "measured too late";
  ASSERT_TRUE(eventually([&] { return simulate.err().find("unplugged") != std::string::npos; }));
  std::this_thread::sleep_for(std::chrono::seconds{1});
  const Work without = work_a_second(run.pid());
  std::printf(
      "%s: %.2f %% of a processor, %.0f wake-ups and %.0f reads a second; "
      "with it %.2f %%, %.0f and %.0f\n",
      device.c_str(), 100 * without.processor_s, without.wake_ups, without.reads,
      100 * whole.processor_s, whole.wake_ups, whole.reads);
  EXPECT_GT(whole.wake_ups, 20.0);
  EXPECT_LE(without.wake_ups, 250.0) << "200 cycles, five looks for the bus";
  EXPECT_LE(without.reads, 1.25 * whole.reads + 50.0);
  EXPECT_EQ(run.stop(SIGINT), 0) << run.err();
}

INSTANTIATE_TEST_SUITE_P(EachLine, UnpluggedLine, ::testing::Values("lidar", "imu", "can"));

}  // namespace
}  // namespace picolo
