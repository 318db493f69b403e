// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// picolo run on a CAN adapter that speaks SLCAN: the test is the adapter.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>

#include "played_line.hpp"
#include "process.hpp"
#include "support/slcan_adapter.hpp"

namespace picolo {
namespace {

using ::testing::HasSubstr;

TEST(SlcanLive, TheControllerOpensAnAdapterAndTalksThroughIt) {
  const test::TemporaryFolder folder;
  const test::PlayedLine line;
  test::SlcanAdapter adapter;
  test::Process run{folder,
                    "run",
                    {"run", "--can", "slcan:" + line.path() + ",250000,1000000", "--lidar", "none",
                     "--imu", "none", "--json"}};
  const std::string foreign = test::SlcanAdapter::line_of({.id = 0x7A0, .length = 1});
  std::array<std::uint8_t, 256> bytes{};
  int foreign_sent = 0;
  for (int i = 0; i < 3000 && (adapter.frames.size() < 20 || foreign_sent < 20); ++i) {
    adapter.take(std::span{bytes}.first(line.take(bytes)));
    const std::string text = adapter.answers + (adapter.open ? foreign : "");
    foreign_sent += adapter.open ? 1 : 0;
    adapter.answers.clear();
    line.send(std::vector<std::uint8_t>(text.begin(), text.end()));
    ::usleep(10'000);
  }
  EXPECT_GE(adapter.frames.size(), 20U) << run.err();
  EXPECT_EQ(adapter.damaged, 0U);
  EXPECT_EQ(adapter.rate, '5');
  EXPECT_EQ(line.rate(), 1'000'000U);
  EXPECT_EQ(run.stop(SIGINT), 0) << run.err();
  const host::Json json = host::Json::parse(run.out());
  EXPECT_GE(json.at("foreign_frames"), 5);
}

TEST(SlcanLive, DoctorTellsAnAdapterFromASilentLine) {
  const test::TemporaryFolder folder;
  const test::PlayedLine silent;
  const test::ToolRun nobody = run_tool(folder, {"doctor", "--can", "slcan:" + silent.path()});
  EXPECT_THAT(nobody.out, HasSubstr("nobody answers on this line"));

  const test::PlayedLine line;
  test::SlcanAdapter adapter;
  test::Process doctor{folder, "doctor", {"doctor", "--can", "slcan:" + line.path()}};
  std::array<std::uint8_t, 256> bytes{};
  for (int i = 0; i < 3000 && adapter.frames.size() < 2; ++i) {
    adapter.take(std::span{bytes}.first(line.take(bytes)));
    // Node 1 answers the question for its type, node 2 does not.
    const std::string text = adapter.answers + (adapter.open ? "t58184300100092010200\r" : "");
    adapter.answers.clear();
    line.send(std::vector<std::uint8_t>(text.begin(), text.end()));
    ::usleep(10'000);
  }
  EXPECT_NE(doctor.wait(), 0);
  EXPECT_THAT(doctor.out(), HasSubstr("node 1 is there"));
  EXPECT_THAT(doctor.out(), HasSubstr("no node 2 on the bus"));
}

TEST(SlcanLive, ANameThatIsNoneIsExplained) {
  const test::TemporaryFolder folder;
  for (const char* name : {"slcan:", "slcan:tty,123456", "slcan:tty,500000,0", "slcan:tty,1,2,3"}) {
    const test::ToolRun run =
        run_tool(folder, {"run", "--can", name, "--lidar", "none", "--imu", "none"});
    EXPECT_EQ(run.exit_code, 2) << name;
    EXPECT_THAT(run.err, HasSubstr("slcan:TTY[,BITRATE[,BAUD]]")) << name;
  }
}

}  // namespace
}  // namespace picolo
