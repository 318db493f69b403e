// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Localisation in a given map, the matchers alone, and the match of two scans.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "room_log.hpp"
#include "support/data.hpp"
#include "tool_run.hpp"
#include "tum_text.hpp"

namespace picolo {
namespace {

using test::out;
using test::run_tool;
using test::TemporaryFolder;
using ::testing::HasSubstr;

/// A folder with a log of the room, its truth, and the map that replay has made of it.
struct Room {
  Room() {
    const test::RoomLog made = test::make_room_log();
    log = folder.write("room.clf", made.carmen);
    truth = folder.write("room.tum", made.truth);
    const auto run = run_tool(folder, {"replay", log, "--save-map", "room.pmap"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr("initialising -> tracking"));
    map = out(folder, "map.pgm");
  }
  [[nodiscard]] test::ToolRun localise(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments{"replay", log,     "--json", "--reference",
                                       truth,    "--out", "loc"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_tool(folder, arguments);
  }
  TemporaryFolder folder;
  std::string log;
  std::string truth;
  std::string map;
};

TEST(ReplayMap, LocalisesInAYamlMapAndLeavesItAsItIs) {
  const Room room;
  const auto run = room.localise({"--map", "picolo-out/map.yaml"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const host::Json json = run.json();
  EXPECT_EQ(json["matched"], 120) << "the first scan meets a map, too";
  EXPECT_EQ(json["heap_calls"], 0);
  EXPECT_LT(json["ape"]["rmse"].get<double>(), 0.02);
  EXPECT_TRUE(test::content_of(room.folder.path() / "loc" / "map.pgm") == room.map);
  EXPECT_GE(json["health"]["scans"]["tracking"].get<int>(), 115);
  EXPECT_EQ(json["health"]["changes"][0]["to"], "tracking");
}

TEST(ReplayMap, AStoredMapLocalisesAsWell) {
  const Room room;
  const auto run = room.localise({"--map", "room.pmap"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.json()["matched"], 120);
  EXPECT_LT(run.json()["ape"]["rmse"].get<double>(), 0.02);
  EXPECT_TRUE(test::content_of(room.folder.path() / "loc" / "map.pgm") == room.map);
}

TEST(ReplayMap, TheInstalledControllerLoadsItFromItsByteStore) {
  const Room room;
  const auto run = room.localise({"--map", "picolo-out/map.yaml", "--wire"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.json()["matched"], 120);
  EXPECT_LT(run.json()["ape"]["rmse"].get<double>(), 0.03);
  EXPECT_GE(run.json()["health"]["scans"]["tracking"].get<int>(), 115);
  EXPECT_TRUE(test::content_of(room.folder.path() / "loc" / "map.pgm") == room.map);
}

TEST(ReplayMap, TheStartMayBeAnywhereInTheFrameOfTheMap) {
  const Room room;
  // The same map, its frame moved by no whole number of cells.
  const std::string yaml = out(room.folder, "map.yaml");
  const std::size_t begin = yaml.find('[') + 1;
  const double x_m = std::stod(yaml.substr(begin));
  const std::string moved =
      yaml.substr(0, begin) + std::to_string(x_m + 7.512) + yaml.substr(yaml.find(',', begin));
  room.folder.write("picolo-out/moved.yaml", moved);
  const auto first = room.localise({"--map", "picolo-out/map.yaml"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  const auto first_pose = [&](const char* file) {
    return test::poses_of(test::content_of(room.folder.path() / "loc" / file)).poses.front();
  };
  const double before_x_m = first_pose("trajectory.tum").x_m;
  const Pose2d start = first_pose("odometry.tum");
  const auto run = room.localise(
      {"--map", "picolo-out/moved.yaml", "--start", std::to_string(start.x_m + 7.512 + 0.15),
       std::to_string(start.y_m - 0.1), std::to_string(start.theta_rad + 0.1)});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NEAR(first_pose("trajectory.tum").x_m, before_x_m + 7.512, 0.02)
      << "found from a start that was off";
}

TEST(ReplayMap, AWrongStartIsFoundOutAtTheFirstScan) {
  const Room room;
  for (const std::vector<std::string>& start :
       {std::vector<std::string>{"--start", "2.5", "-1.5", "2.0"}, {"--start", "40", "40", "0"}}) {
    std::vector<std::string> more{"--map", "picolo-out/map.yaml"};
    more.insert(more.end(), start.begin(), start.end());
    const auto run = room.localise(more);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.json()["matched"], 120);
    EXPECT_LT(run.json()["ape"]["max"].get<double>(), 0.05) << "also that of the first scan";
    EXPECT_GE(run.json()["health"]["scans"]["tracking"].get<int>(), 115);
  }
}

TEST(ReplayMap, AKidnappedVehicleFindsItselfAndTheStateSaysSo) {
  const Room room;
  const test::RoomLog log =
      test::make_room_log({.scans = 70, .kidnapped_at = 30, .kidnapped_by = 50});
  const std::string file = room.folder.write("kidnapped.clf", log.carmen);
  const std::string truth = room.folder.write("kidnapped.tum", log.truth);
  for (const std::vector<std::string>& wire : {std::vector<std::string>{}, {"--wire"}}) {
    std::vector<std::string> arguments{"replay", file,          "--map", "picolo-out/map.yaml",
                                       "--json", "--reference", truth,   "--out",
                                       "kid"};
    arguments.insert(arguments.end(), wire.begin(), wire.end());
    const auto run = run_tool(room.folder, arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const host::Json json = run.json();
    // The scans before it was told pull at the alignment.
    EXPECT_LT(json["ape"]["median"].get<double>(), 0.06);
    bool told = false;
    for (const auto& change : json["health"]["changes"]) {
      const auto scan = change["scan"].get<int>();
      told |= scan >= 30 && scan <= 32 && change["from"] == "tracking";
    }
    EXPECT_TRUE(told) << json["health"].dump();
    EXPECT_EQ(json["health"]["changes"].back()["to"], "tracking");
    EXPECT_GE(json["health"]["scans"]["tracking"].get<int>(), 45);
  }
}

TEST(ReplayMap, WhatCannotBeUsedIsNamed) {
  const Room room;
  EXPECT_EQ(room.localise({"--map", "nothing.yaml"}).exit_code, 3);
  room.folder.write("torn.pmap", test::content_of(room.folder.path() / "room.pmap").substr(0, 100));
  EXPECT_EQ(room.localise({"--map", "torn.pmap"}).exit_code, 3);
  const auto cells = room.localise({"--map", "room.pmap", "--profile", "room"});
  EXPECT_EQ(cells.exit_code, 1);
  EXPECT_THAT(cells.err, HasSubstr("profile"));
  const auto both = room.localise({"--map", "room.pmap", "--matcher", "lm"});
  EXPECT_EQ(both.exit_code, 2);
  const auto unknown = room.localise({"--matcher", "magic"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("gn, lm, ndt, correlative or plicp"));
}

class ReplayMatcher : public ::testing::TestWithParam<const char*> {};

TEST_P(ReplayMatcher, AloneFollowsARoom) {
  const TemporaryFolder folder;
  const test::RoomLog log = test::make_room_log();
  const auto run =
      run_tool(folder, {"replay", folder.write("room.clf", log.carmen), "--json", "--matcher",
                        GetParam(), "--reference", folder.write("room.tum", log.truth)});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const host::Json json = run.json();
  EXPECT_EQ(json["scans"], 120);
  EXPECT_GE(json["matched"].get<int>(), 110);
  EXPECT_EQ(json["heap_calls"], 0);
  EXPECT_LT(json["ape"]["rmse"].get<double>(), 0.04);
  EXPECT_LT(json["ape"]["rmse"].get<double>(), 0.8 * json["ape_odometry"]["rmse"].get<double>());
}

TEST_P(ReplayMatcher, FindsTheMotionBetweenTwoScans) {
  const TemporaryFolder folder;
  const test::RoomLog log = test::make_room_log();
  const std::string file = folder.write("room.clf", log.carmen);
  // Twelve of 120 scans of a circle lie between them; the guess is off by 6 cm and 3 deg.
  const auto reference = run_tool(folder, {"match", file + ":20", "24", "--json"});
  ASSERT_EQ(reference.exit_code, 0) << reference.err;
  const host::Json truth = reference.json()["pose"];
  const auto run =
      run_tool(folder, {"match", file + ":20", file + ":24", "--json", "--matcher", GetParam(),
                        "--guess", std::to_string(truth["x_m"].get<double>() + 0.05),
                        std::to_string(truth["y_m"].get<double>() - 0.03),
                        std::to_string(truth["theta_rad"].get<double>() + 0.05)});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const host::Json pose = run.json()["pose"];
  EXPECT_NEAR(pose["x_m"].get<double>(), truth["x_m"].get<double>(), 0.03);
  EXPECT_NEAR(pose["y_m"].get<double>(), truth["y_m"].get<double>(), 0.03);
  EXPECT_NEAR(pose["theta_rad"].get<double>(), truth["theta_rad"].get<double>(), 0.01);
  EXPECT_THAT(out(folder, "match.svg"), HasSubstr("scan as matched"));
  EXPECT_THAT(out(folder, "match.png").substr(1, 3), testing::Eq("PNG"));
}
INSTANTIATE_TEST_SUITE_P(All, ReplayMatcher,
                         ::testing::Values("gn", "lm", "ndt", "correlative", "plicp"));

TEST(Match, WhatNamesNoScanIsToldWithTheCure) {
  const TemporaryFolder folder;
  const std::string file = folder.write("room.clf", test::make_room_log({.scans = 5}).carmen);
  for (const char* const scan : {"9", "x", "room.clf:", "-1"}) {
    const auto run = run_tool(folder, {"match", file + ":0", "--", scan});
    EXPECT_EQ(run.exit_code, 2) << scan;
  }
  EXPECT_THAT(run_tool(folder, {"match", file + ":0", "9"}).err, HasSubstr("0 to 4"));
  EXPECT_EQ(run_tool(folder, {"match", "0", "1"}).exit_code, 2);
  EXPECT_EQ(run_tool(folder, {"match", "nothing.clf:0", "1"}).exit_code, 3);
}

class MatchPairs : public ::testing::TestWithParam<const char*> {};

TEST_P(MatchPairs, MotionsKnownToPeopleAreFoundFrom20CentimetresAnd10DegreesOff) {
  PICOLO_NEED_DATA("raw2d/intel_pairs.txt");
  const TemporaryFolder folder;
  const auto run = run_tool(
      folder, {"match", test::data_path("raw2d/intel_corrected_rt.clf.gz"), "--pairs",
               test::data_path("raw2d/intel_pairs.txt"), "--matcher", GetParam(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.json()["pairs"], 427);
  EXPECT_LE(run.json()["median_m"].get<double>(), 0.025);
  EXPECT_LE(run.json()["median_rad"].get<double>(), 0.3 / 57.29578);
}
INSTANTIATE_TEST_SUITE_P(All, MatchPairs, ::testing::Values("gn", "correlative", "plicp"));

TEST(Match, AFileThatListsNoPairsIsToldWithTheCure) {
  const TemporaryFolder folder;
  const std::string file = folder.write("room.clf", test::make_room_log({.scans = 5}).carmen);
  const auto match = [&](const std::string& pairs) {
    return run_tool(folder, {"match", file, "--pairs", folder.write("pairs.txt", pairs)});
  };
  const auto torn = match("# i j dx dy dtheta\n0 1 0.1\n");
  EXPECT_EQ(torn.exit_code, 3);
  EXPECT_THAT(torn.err, HasSubstr("line 2"));
  EXPECT_EQ(match("# nothing\n").exit_code, 3);
  EXPECT_EQ(match("0 9 0 0 0\n").exit_code, 2) << "five scans";
}

TEST(Match, RecordedScansAgreeWithTheirReference) {
  PICOLO_NEED_DATA("radish/freiburg-079.clf.gz");
  const TemporaryFolder folder;
  const std::string log = test::data_path("radish/freiburg-079.clf.gz");
  const auto run = run_tool(folder, {"match", log + ":100", "105", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NEAR(run.json()["pose"]["x_m"].get<double>(), 0.53, 0.03);
  EXPECT_GT(run.json()["inlier_share"].get<double>(), 0.6);
}

}  // namespace
}  // namespace picolo
