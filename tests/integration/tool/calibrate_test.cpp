// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The calibrate commands on recordings with published answers, and what they found applied by
// replay.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <regex>
#include <string>
#include <vector>

#include "calibration_log.hpp"
#include "room_log.hpp"
#include "support/data.hpp"
#include "tool_run.hpp"

namespace picolo {
namespace {

using test::data_path;
using test::run_tool;
using test::TemporaryFolder;
using ::testing::HasSubstr;

std::string printed(const host::Json& estimate) {
  return fmt::format("{:.6g}", estimate.at("value").get<double>());
}

void expect_plain_numbers(const std::string& text) {
  EXPECT_FALSE(std::regex_search(text, std::regex{"[0-9][eE][-+]?[0-9]"})) << text;
}

void expect_pictures(const TemporaryFolder& folder) {
  for (const char* name : {"residuals.png", "path.png"}) {
    EXPECT_GT(test::content_of(folder.path() / "picolo-out" / name).size(), 1000U) << name;
  }
  EXPECT_THAT(test::content_of(folder.path() / "picolo-out" / "calibration.json"),
              HasSubstr("refused"));
}

TEST(CalibrateWheels, PrintsThePublishedDigits) {
  PICOLO_NEED_DATA("calib/seed_odom.txt.gz");
  const TemporaryFolder folder;
  const auto run =
      run_tool(folder, {"calibrate", "wheels", "--odometry", data_path("calib/seed_odom.txt.gz"),
                        "--scan-match", data_path("calib/seed_scan_match.txt.gz"), "--limit",
                        "5000", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const host::Json json = run.json();
  const std::vector<std::pair<const char*, const char*>> expected{{"J21", "-0.163886"},
                                                                  {"J22", "0.170575"},
                                                                  {"b", "0.59796"},
                                                                  {"r_L", "0.0979974"},
                                                                  {"r_R", "0.101997"}};
  for (const auto& [key, digits] : expected) {
    EXPECT_EQ(printed(json.at(key)), digits) << key;
    EXPECT_GT(json.at(key).at("std").get<double>(), 0.0);
  }
  EXPECT_EQ(json.at("samples_used"), 5000);
  EXPECT_TRUE(json.at("refused").is_null());
  EXPECT_EQ(json.at("covariance").size(), 3U);
  EXPECT_GT(json.at("condition").get<double>(), 1.0);
  expect_plain_numbers(run.out);
  expect_pictures(folder);
}

TEST(CalibrateJoint, PrintsThePublishedDigitsUnderTheNamesOfTheExpectedFiles) {
  PICOLO_NEED_DATA("calib/censi_l90.tuples.txt.gz");
  const TemporaryFolder folder;
  const std::string file = data_path("calib/censi_l90.tuples.txt.gz");
  const auto run = run_tool(folder, {"calibrate", "joint", file, "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const host::Json json = run.json();
  const std::vector<std::pair<const char*, const char*>> expected{
      {"axle", "0.0880134"},  {"l_diam", "0.0411796"}, {"r_diam", "0.0414408"},
      {"l_x", "-0.00262327"}, {"l_y", "0.00584952"},   {"l_theta", "-1.55772"}};
  for (const auto& [key, digits] : expected) { EXPECT_EQ(printed(json.at(key)), digits) << key; }
  EXPECT_EQ(json.at("covariance").size(), 6U);
  expect_plain_numbers(run.out);
  expect_pictures(folder);
  const auto plain =
      run_tool(folder, {"calibrate", "joint", file, "--json", "--outlier-rounds", "0"});
  EXPECT_EQ(printed(plain.json().at("l_theta")), "-1.48721");
}

TEST(CalibrateTimeOffset, FindsTheClocksOfTheRecordings) {
  PICOLO_NEED_DATA("raw2d/mines_testlab.clf.gz");
  const TemporaryFolder folder;
  const auto lidar = run_tool(folder, {"calibrate", "time-offset", "--json", "--ticks-per-turn",
                                       "2000", data_path("raw2d/mines_testlab.clf.gz")});
  ASSERT_EQ(lidar.exit_code, 0) << lidar.err;
  EXPECT_NEAR(lidar.json().at("offset").at("value").get<double>(), 0.150, 0.02);
  expect_plain_numbers(lidar.out);
  expect_pictures(folder);
  const auto gyro = run_tool(
      folder, {"calibrate", "time-offset", "--json", data_path("imu/ese650_enc_imu_20.txt.gz")});
  ASSERT_EQ(gyro.exit_code, 0) << gyro.err;
  EXPECT_NEAR(gyro.json().at("offset").at("value").get<double>(), 0.04, 0.02);
  EXPECT_EQ(gyro.json().at("sensor"), "gyro");
}

TEST(CalibrateLinear, ReplayAppliesTheMatrix) {
  PICOLO_NEED_DATA("radish/intel.clf.gz");
  const TemporaryFolder folder;
  const std::string log = data_path("radish/intel.clf.gz");
  const auto run = run_tool(folder, {"calibrate", "linear", log, "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.json().at("X").size(), 3U);
  expect_plain_numbers(run.out);
  expect_pictures(folder);
  const auto replay =
      run_tool(folder, {"replay", log, "--calibration", "picolo-out/calibration.json", "--out", "r",
                        "--reference", data_path("radish/intel_ref.tum.gz"), "--json"});
  ASSERT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_LT(replay.json().at("ape_odometry").at("rmse").get<double>(), 24.0 / 4.0);
  EXPECT_LT(replay.json().at("ape").at("rmse").get<double>(), 0.1);
}

TEST(CalibrateExtrinsic, FindsTheMountOfAWrittenDrive) {
  const TemporaryFolder folder;
  const Pose2d mount{0.2, -0.05, 0.1};
  std::string rows;
  for (int k = 0; k < 300; ++k) {
    const Pose2d o{0.05, 0.0, k % 3 == 0 ? 0.0 : (k % 3 == 1 ? 0.1 : -0.1)};
    const Pose2d s = inverse(mount) * o * mount;
    rows += fmt::format("{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", o.x_m, o.y_m, o.theta_rad,
                        s.x_m, s.y_m, s.theta_rad);
  }
  const auto run =
      run_tool(folder, {"calibrate", "extrinsic", folder.write("pairs.txt", rows), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NEAR(run.json().at("yaw").at("value").get<double>(), 0.1, 1e-6);
  EXPECT_NEAR(run.json().at("x").at("value").get<double>(), 0.2, 1e-6);
  EXPECT_NEAR(run.json().at("y").at("value").get<double>(), -0.05, 1e-6);
  expect_pictures(folder);
}

TEST(CalibrateRoutine, ALogThatShowsEverythingIsAccepted) {
  const TemporaryFolder folder;
  const std::string log =
      folder.write("drive.clf", test::calibration_log(test::sufficient_log_legs()));
  const auto run =
      run_tool(folder, {"calibrate", "routine", log, "--ticks-per-turn", "20000", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err << run.out;
  const host::Json json = run.json();
  const auto value = [&](const char* key) { return json.at(key).at("value").get<double>(); };
  const DriveParameters& truth = test::kLogDrive;
  EXPECT_NEAR(value("axle"), truth.track_m, 2e-3 * truth.track_m);
  EXPECT_NEAR(value("l_diam"), 2.0 * truth.radius_left_m, 4e-3 * truth.radius_left_m);
  EXPECT_NEAR(value("r_diam"), 2.0 * truth.radius_right_m, 4e-3 * truth.radius_right_m);
  EXPECT_NEAR(value("l_x"), truth.base_T_lidar.x_m, 0.004);
  EXPECT_NEAR(value("l_y"), truth.base_T_lidar.y_m, 0.004);
  EXPECT_NEAR(value("l_theta"), truth.base_T_lidar.theta_rad, 0.004);
  EXPECT_NEAR(value("time_offset"), test::kLogLidarAge_s, 0.002);
  EXPECT_EQ(json.at("phase"), "done");
  EXPECT_TRUE(json.at("refused").is_null());
  expect_plain_numbers(run.out);
  expect_pictures(folder);
}

TEST(CalibrateRoutine, ALogWithoutTurnsIsRefusedByName) {
  const TemporaryFolder folder;
  const std::string log = folder.write(
      "straight.clf", test::calibration_log({{4, 4, 6}, {-4, -4, 6}, {4, 4, 6}, {-4, -4, 6}}));
  const auto run = run_tool(folder, {"calibrate", "routine", log, "--ticks-per-turn", "20000"});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("refused: track_width is not determined: only straight driving"));
  EXPECT_THAT(run.out, HasSubstr("turn on the spot to the left"));
}

TEST(CalibrateTrack, TheRecordingsOwnCameraGivesTheWheels) {
  PICOLO_NEED_DATA("calib/lego_robot4.txt.gz");
  const TemporaryFolder folder;
  const std::string log = data_path("calib/lego_robot4.txt.gz");
  const auto run = run_tool(folder, {"calibrate", "track", log, "--nominal-radius", "0.000349",
                                     "--nominal-track", "0.150", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_GT(run.json().at("rms_before_m").get<double>(), 0.4);
  EXPECT_LT(run.json().at("rms_after_m").get<double>(), 0.026) << "best fit known before";
  EXPECT_NEAR(run.json().at("b").at("value").get<double>(), 0.173, 0.002) << "the lecture's track";
  expect_pictures(folder);
  const auto half = run_tool(folder, {"calibrate", "track", log, "--nominal-radius", "0.000349",
                                      "--nominal-track", "0.150", "--fit-share", "0.5", "--json"});
  ASSERT_EQ(half.exit_code, 0) << half.err;
  EXPECT_LT(half.json().at("rms_whole_recording_m").get<double>(), 0.070)
      << "the other half was not fitted";
}

TEST(CalibrateMemory, NamesEveryEstimator) {
  const TemporaryFolder folder;
  const auto run = run_tool(folder, {"calibrate", "memory", "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  for (const char* name : {"linear", "wheels", "extrinsic", "joint", "motion_check", "gyro"}) {
    EXPECT_GT(run.json().at("bytes").at(name).get<int>(), 100) << name;
    EXPECT_LT(run.json().at("bytes").at(name).get<int>(), 8192) << name;
  }
}

TEST(ReplayCalibration, WheelsTurnTicksIntoOdometry) {
  const TemporaryFolder folder;
  test::RoomLog log = test::make_room_log();
  // 1 mm a count, track 0.5 m: the circle of 2.4 m radius in steps of 0.03 rad.
  std::string ticks = "TICKS 99.99 0 0\n";
  for (int i = 0; i < 120; ++i) {
    ticks += fmt::format("TICKS {:.6f} {:.6f} {:.6f}\n", 100.0 + 0.1 * i, 1e3 * 2.15 * 0.03 * i,
                         1e3 * 2.65 * 0.03 * i);
  }
  const std::string file = folder.write("ticks.clf", log.carmen + ticks);
  const std::string truth = folder.write("room.tum", log.truth);
  const std::string wheels =
      folder.write("wheels.json", R"({"r_L":0.001,"r_R":0.001,"b":0.5,"refused":null})");
  const auto run = run_tool(folder, {"replay", file, "--calibration", wheels, "--reference", truth,
                                     "--json", "--out", "a"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_LT(run.json().at("ape_odometry").at("rmse").get<double>(), 1e-3);
  const std::string matrix =
      folder.write("x.json", fmt::format(R"({{"X":[[1,0,0],[0,1,0],[0,0,{:.9f}]]}})", 1.0 / 1.03));
  const auto corrected = run_tool(folder, {"replay", file, "--calibration", matrix, "--reference",
                                           truth, "--json", "--out", "b"});
  ASSERT_EQ(corrected.exit_code, 0) << corrected.err;
  EXPECT_LT(corrected.json().at("ape_odometry").at("rmse").get<double>(), 1e-3);
}

TEST(ReplayCalibration, FilesThatCannotBeAppliedAreNamedWithCauseAndCure) {
  const TemporaryFolder folder;
  const std::string log = folder.write("room.clf", test::make_room_log({.scans = 10}).carmen);
  const auto failed = [&](const std::string& json, const char* cause) {
    const auto run =
        run_tool(folder, {"replay", log, "--calibration", folder.write("c.json", json)});
    EXPECT_EQ(run.exit_code, 3) << json;
    EXPECT_THAT(run.err, HasSubstr(cause));
  };
  failed("no json", "is no JSON object");
  failed("{}", "holds neither X");
  failed(R"({"refused":"lidar_x: too little data"})", "was refused: lidar_x");
  failed(R"({"r_L":0.1,"r_R":0.1,"b":0.5})", "holds no TICKS");
}

}  // namespace
}  // namespace picolo
