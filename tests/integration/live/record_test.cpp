// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What was recorded comes back bit for bit; what differs is told.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tool_run.hpp"

namespace picolo {
namespace {

using test::run_tool;
using test::TemporaryFolder;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// Four seconds of the demo, recorded once for all tests.
class Recording : public ::testing::Test {
 protected:
  void SetUp() override {
    const test::ToolRun run =
        run_tool(folder, {"demo", "--seconds", "4", "--record", "rec", "--out", "demo", "--json"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
  }
  [[nodiscard]] std::string bytes(const std::string& file) const {
    return test::content_of(folder.path() / file);
  }
  TemporaryFolder folder;
};

TEST_F(Recording, ReplaysBitForBit) {
  const test::ToolRun replay = run_tool(folder, {"replay", "rec", "--out", "again", "--json"});
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  const host::Json json = replay.json();
  EXPECT_EQ(json.at("cycles"), 800);
  EXPECT_EQ(json.at("differences"), 0);
  EXPECT_TRUE(json.at("same"));
  EXPECT_FALSE(bytes("rec/trajectory.tum").empty());
  EXPECT_EQ(bytes("again/trajectory.tum"), bytes("rec/trajectory.tum"));
  EXPECT_EQ(bytes("demo/trajectory.tum"), bytes("rec/trajectory.tum"));
}

TEST_F(Recording, RecordingChangesNothing) {
  const test::ToolRun plain =
      run_tool(folder, {"demo", "--seconds", "4", "--out", "plain", "--json"});
  ASSERT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_EQ(bytes("plain/trajectory.tum"), bytes("rec/trajectory.tum"));
}

TEST_F(Recording, AnotherConfigurationOrADamagedByteIsTold) {
  folder.write("other.toml", "[vehicle]\ntrack_m = 0.51\n");
  const test::ToolRun other =
      run_tool(folder, {"replay", "rec", "--config", "other.toml", "--out", "other"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr("other poses or frames than recorded"));
  std::string raw = bytes("rec/lidar.raw");
  raw[raw.size() / 2] = static_cast<char>(raw[raw.size() / 2] ^ 0x40);
  folder.write("rec/lidar.raw", raw);
  EXPECT_EQ(run_tool(folder, {"replay", "rec", "--out", "damaged"}).exit_code, 1);
  fs::remove(folder.path() / "rec/imu.stamps");
  const test::ToolRun missing = run_tool(folder, {"replay", "rec", "--out", "missing"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("imu.stamps"));
}

TEST_F(Recording, WithoutCyclesItReplaysByArrivalTimesTheSameEachTime) {
  fs::remove(folder.path() / "rec/cycles.log");
  fs::rename(folder.path() / "rec/can.log", folder.path() / "rec/candump-2026-11-22_080000.log");
  const test::ToolRun first =
      run_tool(folder, {"replay", "rec", "--out", "a", "--json", "--reference", "demo/truth.tum"});
  const test::ToolRun second = run_tool(folder, {"replay", "rec", "--out", "b", "--json"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_FALSE(first.json().at("recorded_cycles"));
  EXPECT_GT(first.json().at("matched"), 25);
  EXPECT_EQ(first.json().at("pose_hash"), second.json().at("pose_hash"));
  EXPECT_EQ(bytes("a/trajectory.tum"), bytes("b/trajectory.tum"));
  const test::ToolRun ape =
      run_tool(folder, {"evaluate", "ape", "demo/truth.tum", "a/trajectory.tum", "--json"});
  ASSERT_EQ(ape.exit_code, 0) << ape.err;
  EXPECT_LT(ape.json().at("rmse"), 0.05) << "half a cell of it is the map's";
}

TEST_F(Recording, RawCapturesWithoutStampsAreSpreadOverTheTimeOfTheCanLog) {
  fs::remove(folder.path() / "rec/cycles.log");
  fs::remove(folder.path() / "rec/lidar.stamps");
  fs::remove(folder.path() / "rec/imu.stamps");
  const test::ToolRun run = run_tool(folder, {"replay", "rec", "--out", "a", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("spread evenly"));
  EXPECT_GT(run.json().at("matched"), 15);
}

TEST_F(Recording, ABadLineOfACandumpLogIsSkippedAndCanFdIgnored) {
  fs::remove(folder.path() / "rec/cycles.log");
  const std::string log = bytes("rec/can.log");
  folder.write("rec/can.log", "(0000000000.000000) can0 123##1AABB\nnonsense\n" + log);
  const test::ToolRun run = run_tool(folder, {"replay", "rec", "--out", "a", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("can.log:2"));
  EXPECT_GT(run.json().at("matched"), 25);
}

TEST(RecordingFolder, WithoutACanLogIsRefusedWithWhatIsMissing) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "rec");
  const test::ToolRun run = run_tool(folder, {"replay", "rec"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("holds no CAN log"));
}

}  // namespace
}  // namespace picolo
