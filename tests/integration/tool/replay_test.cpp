// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "room_log.hpp"
#include "support/data.hpp"
#include "tool_run.hpp"
#include "tum_text.hpp"

namespace picolo {
namespace {

using test::first_fields;
using test::out;
using test::run_tool;
using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST(Replay, ADriveInARoomFollowsTheTruthAndWritesEverything) {
  const TemporaryFolder folder;
  const test::RoomLog log = test::make_room_log();
  const auto run = run_tool(folder, {"replay", folder.write_gz("room.clf.gz", log.carmen), "--json",
                                     "--reference", folder.write("room.tum", log.truth)});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty());
  const host::Json json = run.json();
  EXPECT_EQ(json["scans"], 120);
  EXPECT_EQ(json["matched"], 119);
  EXPECT_EQ(json["heap_calls"], 0);
  EXPECT_EQ(json["ape"]["pairs"], 120);
  EXPECT_LT(json["ape"]["rmse"].get<double>(), 0.02);
  EXPECT_GT(json["ape_odometry"]["rmse"].get<double>(), 0.04);
  for (const char* key : {"match_us", "total_us", "iterations"}) {
    EXPECT_GT(json[key]["p50"].get<double>(), 0.0) << key;
    EXPECT_GE(json[key]["p99"].get<double>(), json[key]["p50"].get<double>()) << key;
  }
  int outcomes = 0;
  for (const auto& [name, count] : json["outcomes"].items()) { outcomes += count.get<int>(); }
  EXPECT_EQ(outcomes, 119) << "one a scan that met a map";
  EXPECT_FALSE(std::regex_search(run.out, std::regex{"[0-9][eE][-+]?[0-9]"})) << run.out;
  EXPECT_EQ(first_fields(out(folder, "trajectory.tum")), first_fields(log.truth));
  EXPECT_EQ(first_fields(out(folder, "odometry.tum")), first_fields(log.truth));
  EXPECT_THAT(out(folder, "map.pgm"), testing::StartsWith("P5\n"));
  EXPECT_THAT(out(folder, "map.yaml"), HasSubstr("resolution: 0.05"));
  EXPECT_THAT(out(folder, "picture.png").substr(1, 3), testing::Eq("PNG"));
  EXPECT_THAT(out(folder, "picture.svg"), HasSubstr("picolo"));
}

TEST(Replay, TwoRunsAreByteIdentical) {
  const TemporaryFolder folder;
  const std::string log = folder.write("room.clf", test::make_room_log().carmen);
  ASSERT_EQ(run_tool(folder, {"replay", log, "--out", "a"}).exit_code, 0);
  ASSERT_EQ(run_tool(folder, {"replay", log, "--out", "b"}).exit_code, 0);
  for (const char* name : {"trajectory.tum", "map.pgm", "map.yaml", "picture.png"}) {
    EXPECT_EQ(test::content_of(folder.path() / "a" / name),
              test::content_of(folder.path() / "b" / name))
        << name;
  }
}

TEST(Replay, WithoutOdometryItStillFollows) {
  const TemporaryFolder folder;
  const test::RoomLog log = test::make_room_log();
  const auto run =
      run_tool(folder, {"replay", folder.write("room.clf", log.carmen), "--json", "--no-odometry",
                        "--reference", folder.write("room.tum", log.truth)});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(run.json()["ape"]["rmse"].get<double>(), 0.05);
}

TEST(Replay, OdometryThatNeverMovesIsToldAndNotUsed) {
  const TemporaryFolder folder;
  const test::RoomLog log = test::make_room_log({.odometry = false});
  const auto run = run_tool(folder, {"replay", folder.write("room.clf", log.carmen), "--json",
                                     "--reference", folder.write("room.tum", log.truth)});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("never moves"));
  EXPECT_LT(run.json()["ape"]["rmse"].get<double>(), 0.05);
}

class ReplayStamps : public ::testing::TestWithParam<double> {};

TEST_P(ReplayStamps, ThatDoNotIncreaseWarnOnceAndKeepFileOrder) {
  const TemporaryFolder folder;
  const test::RoomLog log = test::make_room_log({.scans = 40, .period_s = GetParam()});
  const auto run = run_tool(folder, {"replay", folder.write("room.clf", log.carmen), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  EXPECT_THAT(run.err, HasSubstr("stamps do not increase"));
  EXPECT_EQ(run.json()["matched"], 39);
  EXPECT_EQ(first_fields(out(folder, "trajectory.tum")), first_fields(log.truth));
}
INSTANTIATE_TEST_SUITE_P(Kinds, ReplayStamps, ::testing::Values(0.0, -0.25, 1e-7));

TEST(Replay, TheResultDoesNotDependOnTheClock) {
  const TemporaryFolder folder;
  const auto poses = [&](double period_s) {
    const test::RoomLog log = test::make_room_log({.scans = 40, .period_s = period_s});
    run_tool(folder, {"replay", folder.write("room.clf", log.carmen)});
    std::string text;
    std::istringstream lines{out(folder, "trajectory.tum")};
    for (std::string line; std::getline(lines, line);) { text += line.substr(line.find(' ')); }
    return text;
  };
  const std::string regular = poses(0.1);
  EXPECT_FALSE(regular.empty());
  EXPECT_EQ(poses(0.0), regular);
  EXPECT_EQ(poses(3.0), regular);
}

TEST(Replay, BadLinesAreSkippedAndNamed) {
  const TemporaryFolder folder;
  std::string text = test::make_room_log({.scans = 10}).carmen;
  text.insert(text.find('\n') + 1, "FLASER 360 1 2 3\nnonsense\n");
  const auto run = run_tool(folder, {"replay", folder.write("room.clf", text), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("room.clf:2: "));
  EXPECT_EQ(run.json()["scans"], 10);
}

TEST(Replay, ATruncatedGzIsReplayedAsFarAsItGoesAndExits3) {
  const TemporaryFolder folder;
  const std::string whole =
      test::content_of(folder.write_gz("whole.gz", test::make_room_log().carmen));
  const auto run = run_tool(
      folder, {"replay", folder.write("cut.gz", whole.substr(0, whole.size() / 2)), "--json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("cut.gz: the compressed file ends too early"));
  EXPECT_GT(run.json()["scans"].get<int>(), 30);
  EXPECT_LT(run.json()["scans"].get<int>(), 120);
  EXPECT_EQ(first_fields(out(folder, "trajectory.tum")).size(),
            run.json()["scans"].get<std::size_t>());
}

TEST(Replay, ALogWithoutScansIs3) {
  const TemporaryFolder folder;
  for (const char* content : {"", "ODOM 0 0 0 0 0 0 1 h 1\n", "FLASER 2 1\n"}) {
    const auto run = run_tool(folder, {"replay", folder.write("a.clf", content)});
    EXPECT_EQ(run.exit_code, 3) << content;
    EXPECT_THAT(run.err, HasSubstr("a.clf"));
  }
}

TEST(Replay, ScansThatSeeNothingAreRefused) {
  const TemporaryFolder folder;
  std::string text;
  for (int i = 0; i < 10; ++i) {
    text += fmt::format("FLASER 3 81 81 81 0 0 0 {} 0 0 {} h 0\n", i, i);
  }
  const auto run = run_tool(folder, {"replay", folder.write("a.clf", text), "--json"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("0 of 10 scans matched"));
  EXPECT_EQ(run.json()["matched"], 0) << "what was found is told all the same";
}

TEST(Replay, AReferenceOfAnotherDriveIsRefusedAndAMissingOneIs3) {
  const TemporaryFolder folder;
  const std::string log = folder.write("a.clf", test::make_room_log({.scans = 20}).carmen);
  const std::string other =
      folder.write("o.tum", test::make_room_log({.scans = 9, .first_stamp_s = 1e6}).truth);
  const auto run = run_tool(folder, {"replay", log, "--json", "--reference", other});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("o.tum"));
  EXPECT_TRUE(run.json()["ape"]["rmse"].is_null());
  EXPECT_EQ(run_tool(folder, {"replay", log, "--reference", "missing.tum"}).exit_code, 3);
}

TEST(Replay, ProfilesAreChosenByNameAndTooManyBeamsAreTold) {
  const TemporaryFolder folder;
  const std::string log = folder.write("a.clf", test::make_room_log({.scans = 20}).carmen);
  const auto room = run_tool(folder, {"replay", log, "--profile", "room"});
  EXPECT_EQ(room.exit_code, 0) << room.err;
  EXPECT_THAT(out(folder, "map.yaml"), HasSubstr("resolution: 0.08"));
  EXPECT_EQ(run_tool(folder, {"replay", log, "--profile", "palace"}).exit_code, 2);
  std::string wide = "FLASER 900";
  for (int i = 0; i < 900; ++i) { wide += " 1"; }
  const auto run = run_tool(folder, {"replay", folder.write("w.clf", wide + " 0 0 0 0 0 0 1 h 1\n"),
                                     "--profile", "room"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("900 beams"));
}

TEST(Replay, ConfigurationReachesTheLocaliser) {
  const TemporaryFolder folder;
  const std::string log = folder.write("a.clf", test::make_room_log({.scans = 20}).carmen);
  const std::string config = folder.write(
      "c.toml", "[replay]\nprofile = \"room\"\n[localiser.fine]\nmax_iterations = 1\n");
  const auto run = run_tool(folder, {"replay", log, "--json", "--config", config});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(run.json()["outcomes"]["iteration_limit"].get<int>(), 10);
  folder.write("c.toml", "[localiser.fine]\nmax_iterations = 0\n");
  EXPECT_EQ(run_tool(folder, {"replay", log, "--config", config}).exit_code, 2);
}

TEST(Replay, SweepsAreUndistortedAndMatched) {
  PICOLO_NEED_DATA("imu/undistort_sweeps_a.txt.gz");
  const TemporaryFolder folder;
  const auto run =
      run_tool(folder, {"replay", test::data_path("imu/undistort_sweeps_a.txt.gz").string(),
                        "--lidar", "0.21", "0", "3.14159265", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(run.json()["matched"].get<int>(), 320);
}

double recorded_ape_m(const std::string& name) {
  const TemporaryFolder folder;
  const auto run =
      run_tool(folder, {"replay", test::data_path(name + ".clf.gz").string(), "--json",
                        "--reference", test::data_path(name + "_ref.tum.gz").string()});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.json()["heap_calls"], 0);
  return run.json()["ape"]["rmse"].get<double>();
}

TEST(Replay, RecordedKeyScansOfFreiburg101) {
  PICOLO_NEED_DATA("radish/freiburg-101.clf.gz");
  EXPECT_LE(recorded_ape_m("radish/freiburg-101"), 0.20);
}

TEST(Replay, RecordedDriveThroughFreiburg079) {
  PICOLO_NEED_DATA("radish/freiburg-079.clf.gz");
  EXPECT_LE(recorded_ape_m("radish/freiburg-079"), 0.10);
}

class RecordedWithoutReference : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedWithoutReference, MatchesNearlyEveryScan) {
  PICOLO_NEED_DATA(GetParam());
  const TemporaryFolder folder;
  const auto run = run_tool(folder, {"replay", test::data_path(GetParam()).string(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(run.json()["matched"].get<double>(), 0.97 * run.json()["scans"].get<double>());
  EXPECT_EQ(run.json()["heap_calls"], 0);
}
INSTANTIATE_TEST_SUITE_P(Logs, RecordedWithoutReference,
                         ::testing::Values("raw2d/mines_exp1.clf.gz",
                                           "raw2d/malaga_sena_loop.clf.gz",
                                           "raw2d/ccny_handheld.clf.gz",
                                           "raw2d/laserazos_sm3.clf.gz"));

}  // namespace
}  // namespace picolo
