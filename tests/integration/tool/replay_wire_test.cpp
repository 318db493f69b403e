// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>
#include <string>

#include "room_log.hpp"
#include "support/data.hpp"
#include "tool_run.hpp"
#include "tum_text.hpp"

namespace picolo {
namespace {

using test::expect_close;
using test::first_fields;
using test::out;
using test::run_tool;
using test::TemporaryFolder;
using ::testing::IsEmpty;

TEST(ReplayThroughWires, GivesThePosesOfDirectReplay) {
  const TemporaryFolder folder;
  const test::RoomLog log = test::make_room_log({.scans = 60});
  const std::string carmen = folder.write("room.clf", log.carmen);
  ASSERT_EQ(run_tool(folder, {"replay", carmen, "--out", "direct"}).exit_code, 0);
  const auto run = run_tool(folder, {"replay", carmen, "--wire", "--out", "wire", "--json",
                                     "--reference", folder.write("room.tum", log.truth)});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty());
  const host::Json json = run.json();
  EXPECT_EQ(json["scans"], 60);
  EXPECT_EQ(json["matched"], 59);
  EXPECT_EQ(json["heap_calls"], 0);
  EXPECT_LT(json["ape"]["rmse"].get<double>(), 0.02);
  EXPECT_GT(json["match_us"]["p50"].get<double>(), 0.0);
  const auto file = [&](const char* name) { return test::content_of(folder.path() / name); };
  expect_close(file("direct/odometry.tum"), file("wire/odometry.tum"), 0.005, 1e-4);
  expect_close(file("direct/trajectory.tum"), file("wire/trajectory.tum"), 0.01, 0.003);
}

TEST(ReplayThroughWires, StampsAreTheLogsWhateverTheyAre) {
  const TemporaryFolder folder;
  const test::RoomLog log = test::make_room_log({.scans = 10, .period_s = 0.0});
  const auto run = run_tool(folder, {"replay", folder.write("room.clf", log.carmen), "--wire"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(first_fields(out(folder, "trajectory.tum")), first_fields(log.truth));
}

TEST(ReplayThroughWires, NeedsOdometryAndScansOfAnInstant) {
  const TemporaryFolder folder;
  const std::string log = folder.write("room.clf", test::make_room_log({.scans = 5}).carmen);
  EXPECT_EQ(run_tool(folder, {"replay", log, "--wire", "--no-odometry"}).exit_code, 2);
  const std::string sweeps =
      folder.write("s.log", "ODOM 0 0 0 0 0 0 0 h 0\nSWEEP 0 0.1 2 1 0 1 1 1\n");
  EXPECT_EQ(run_tool(folder, {"replay", sweeps, "--wire"}).exit_code, 2);
}

TEST(ReplayThroughWires, RecordedKeyScansOfFreiburg101AreWithinLimitsOfDirectReplay) {
  PICOLO_NEED_DATA("radish/freiburg-101.clf.gz");
  const TemporaryFolder folder;
  const std::string log = test::data_path("radish/freiburg-101.clf.gz").string();
  ASSERT_EQ(run_tool(folder, {"replay", log, "--out", "direct"}).exit_code, 0);
  const auto run =
      run_tool(folder, {"replay", log, "--wire", "--out", "wire", "--json", "--reference",
                        test::data_path("radish/freiburg-101_ref.tum.gz").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LE(run.json()["ape"]["rmse"].get<double>(), 0.22);
  EXPECT_EQ(run.json()["heap_calls"], 0);
  const auto file = [&](const char* name) { return test::content_of(folder.path() / name); };
  expect_close(file("direct/odometry.tum"), file("wire/odometry.tum"), 0.005, 1e-4);
  expect_close(file("direct/trajectory.tum"), file("wire/trajectory.tum"), 0.05,
               0.5 * std::numbers::pi / 180.0);
}

}  // namespace
}  // namespace picolo
