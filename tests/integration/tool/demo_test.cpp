// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tool_run.hpp"

namespace picolo {
namespace {

using test::run_tool;
using test::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// The first word of every line that is no comment.
std::vector<std::string> stamps_of(const std::filesystem::path& tum) {
  std::istringstream lines{test::content_of(tum)};
  std::vector<std::string> stamps;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty() && line[0] != '#') { stamps.push_back(line.substr(0, line.find(' '))); }
  }
  return stamps;
}

TEST(Demo, DriveThroughTheWholeChainFollowsTheTruthWithoutTheHeap) {
  const TemporaryFolder folder;
  const test::ToolRun run = run_tool(folder, {"demo", "--seconds", "60", "--seed", "3", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, IsEmpty()) << "no progress without a terminal";
  const host::Json json = run.json();
  EXPECT_GT(json["scans"], 590);
  EXPECT_EQ(json["matched"].get<int>() + 1, json["scans"].get<int>()) << "the first founds the map";
  int outcomes = 0;
  for (const auto& [name, count] : json["outcomes"].items()) { outcomes += count.get<int>(); }
  EXPECT_EQ(outcomes, json["matched"].get<int>());
  EXPECT_EQ(json["heap_calls"], 0);
  EXPECT_EQ(json["state"], "tracking");
  EXPECT_LT(json["ape"]["rmse"], 0.03);
  EXPECT_GT(json["ape_odometry"]["rmse"].get<double>(), 2.0 * json["ape"]["rmse"].get<double>());
  EXPECT_GT(json["ape"]["pairs"], 590);
  for (const char* key : {"rmse", "mean", "median", "max", "pairs"}) {
    EXPECT_TRUE(json["ape"].contains(key) && json["ape_odometry"].contains(key)) << key;
  }
  std::vector<std::string> names;
  for (const host::Json& task : json["tasks"]) {
    names.push_back(task["name"]);
    EXPECT_GE(task["worst_us"], task["median_us"]);
    EXPECT_GT(task["worst_us"], 0.0);
  }
  EXPECT_THAT(names, ElementsAre("can", "serial", "odometry", "undistort", "match", "map",
                                 "background", "report"));

  const std::filesystem::path out = folder.path() / "picolo-out";
  const std::vector<std::string> stamps = stamps_of(out / "trajectory.tum");
  EXPECT_GT(stamps.size(), 590U);
  EXPECT_EQ(stamps_of(out / "odometry.tum"), stamps);
  EXPECT_EQ(stamps_of(out / "truth.tum"), stamps);
  EXPECT_THAT(test::content_of(out / "map.yaml"), HasSubstr("resolution: 0.05"));
  for (const char* name : {"map.pgm", "picture.svg", "picture.png"}) {
    EXPECT_GT(std::filesystem::file_size(out / name), 1000U) << name;
  }
}

TEST(Demo, SameSeedGivesTheSameBytesAndAnotherSeedDoesNot) {
  const TemporaryFolder folder;
  const auto files = [&folder](const std::string& out, const std::string& seed) {
    EXPECT_EQ(run_tool(folder, {"demo", "--seconds", "10", "--seed", seed, "--out", out}).exit_code,
              0);
    std::string all;
    for (const char* name :
         {"trajectory.tum", "odometry.tum", "truth.tum", "map.pgm", "picture.svg", "picture.png"}) {
      all += test::content_of(folder.path() / out / name);
    }
    return all;
  };
  const std::string first = files("first", "5");
  EXPECT_EQ(files("second", "5"), first);
  EXPECT_NE(files("third", "6"), first);
}

TEST(Demo, SettingsComeFromTheFileAndTheCommandLineWins) {
  const TemporaryFolder folder;
  const std::string config = folder.write("demo.toml", "[demo]\nseconds = 4\nseed = 9\n");
  const host::Json from_file = run_tool(folder, {"demo", "--json", "--config", config}).json();
  EXPECT_EQ(from_file["seconds"], 4);
  EXPECT_EQ(from_file["seed"], 9);
  const host::Json overruled =
      run_tool(folder, {"demo", "--json", "--config", config, "--seconds", "3"}).json();
  EXPECT_EQ(overruled["seconds"], 3);
  EXPECT_EQ(overruled["seed"], 9);
}

TEST(Demo, SettingsOutOfTheirDomainAreUsageErrors) {
  const TemporaryFolder folder;
  EXPECT_EQ(run_tool(folder, {"demo", "--seconds", "0"}).exit_code, 2);
  EXPECT_EQ(run_tool(folder, {"demo", "--seconds", "3601"}).exit_code, 2);
  EXPECT_EQ(run_tool(folder, {"demo", "--seed", "-1"}).exit_code, 2);
  EXPECT_EQ(run_tool(folder, {"demo", "extra"}).exit_code, 2);
  const test::ToolRun run =
      run_tool(folder, {"demo", "--config", folder.write("bad.toml", "[demo]\nseconds = -5\n")});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("bad.toml"));
  EXPECT_EQ(
      run_tool(folder, {"demo", "--config", folder.write("typo.toml", "[demo]\nsecond = 5\n")})
          .exit_code,
      2);
}

}  // namespace
}  // namespace picolo
