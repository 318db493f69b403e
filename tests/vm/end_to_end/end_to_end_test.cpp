// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Judges the drive of two processes on vcan0 and pseudo-terminals: see the script `drive`.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <sstream>

#include "bus_log.hpp"
#include "picolo/host/json.hpp"
#include "support/files.hpp"
#include "support/paths.hpp"

namespace picolo::test {
namespace {

constexpr double kDriveSeconds = 30.0;
constexpr double kSilentWrongM = 0.20;
constexpr double kSilentWrongRad = 3.0 * 3.14159265358979 / 180.0;

struct TruePose {
  double stamp_s = 0.0;
  Pose2d map_T_base{};
};

std::filesystem::path left(const char* name) {
  return std::filesystem::path{PICOLO_DRIVE_RESULTS} / name;
}

std::vector<TruePose> read_truth() {
  std::vector<TruePose> truth;
  std::istringstream lines{content_of(left("truth.tum"))};
  double t = 0.0, x = 0.0, y = 0.0, z = 0.0, qx = 0.0, qy = 0.0, qz = 0.0, qw = 0.0;
  while (lines >> t >> x >> y >> z >> qx >> qy >> qz >> qw) {
    truth.push_back({t, {x, y, 2.0 * std::atan2(qz, qw)}});
  }
  return truth;
}

double turn(double from_rad, double to_rad) {
  return std::remainder(to_rad - from_rad, 2 * M_PI);
}

class Drive : public ::testing::Test {
 protected:
  void SetUp() override {
    if (std::filesystem::exists(left("skipped"))) {
      std::istringstream text{content_of(left("skipped"))};
      std::string line, last;
      while (std::getline(text, line)) { last = line; }
      GTEST_SKIP() << last;
    }
    truth_ = read_truth();
    ASSERT_GT(truth_.size(), 1000U);
    run_ = host::Json::parse(content_of(left("run.json")));
  }
  /// Between its two neighbours.
  [[nodiscard]] std::optional<Pose2d> truth_at(double stamp_s) const {
    const auto after =
        std::lower_bound(truth_.begin(), truth_.end(), stamp_s,
                         [](const TruePose& pose, double stamp) { return pose.stamp_s < stamp; });
    if (after == truth_.begin() || after == truth_.end()) { return std::nullopt; }
    const TruePose& a = *(after - 1);
    const TruePose& b = *after;
    const double part = (stamp_s - a.stamp_s) / (b.stamp_s - a.stamp_s);
    const auto mix = [part](double from, double to) { return from + part * (to - from); };
    return Pose2d{
        mix(a.map_T_base.x_m, b.map_T_base.x_m), mix(a.map_T_base.y_m, b.map_T_base.y_m),
        a.map_T_base.theta_rad + part * turn(a.map_T_base.theta_rad, b.map_T_base.theta_rad)};
  }
  [[nodiscard]] double start_s() const { return truth_.front().stamp_s; }

  Dbc dbc_ = read_dbc(content_of(source_dir() / "docs/picolo.dbc"));
  BusLog log_{left("candump.log").string(), dbc_};
  std::vector<TruePose> truth_;
  host::Json run_;
};

TEST_F(Drive, BothProcessesEndWellWhenTheyAreTold) {
  EXPECT_EQ(content_of(left("run.exit")), "0\n") << content_of(left("run.log"));
  EXPECT_EQ(content_of(left("simulate.exit")), "0\n") << content_of(left("simulate.log"));
  EXPECT_LT(run_["slipped"].get<int>(), run_["cycles"].get<int>() / 100);
}

TEST_F(Drive, PosesOnTheBusAgreeWithTheTruthFor30Seconds) {
  std::size_t compared = 0;
  double worst_m = 0.0;
  double worst_rad = 0.0;
  double square_sum = 0.0;
  for (const Report& report : log_.reports()) {
    const auto truth = truth_at(report.stamp_s);
    if (!truth || report.stamp_s > start_s() + kDriveSeconds) { continue; }
    const double error_m =
        std::hypot(report.map_T_base.x_m - truth->x_m, report.map_T_base.y_m - truth->y_m);
    worst_m = std::max(worst_m, error_m);
    worst_rad = std::max(worst_rad, std::abs(turn(truth->theta_rad, report.map_T_base.theta_rad)));
    square_sum += error_m * error_m;
    if (compared++ % 200 == 0) {
      std::printf("%s  x %7.3f y %7.3f yaw %7.4f  truth x %7.3f y %7.3f yaw %7.4f  %.1f mm\n",
                  report.line.c_str(), report.map_T_base.x_m, report.map_T_base.y_m,
                  report.map_T_base.theta_rad, truth->x_m, truth->y_m, truth->theta_rad,
                  1000.0 * error_m);
    }
  }
  std::printf("%zu frames, %zu poses compared: rms %.4f m, worst %.4f m, %.4f rad\n", log_.frames(),
              compared,
              std::sqrt(square_sum / static_cast<double>(std::max<std::size_t>(compared, 1))),
              worst_m, worst_rad);
  EXPECT_GE(compared, 1100U);  // of 1200, one each 25 ms
  EXPECT_LT(worst_m, 0.05);
  const auto end = truth_at(start_s() + kDriveSeconds);
  ASSERT_TRUE(end);
  EXPECT_GT(std::hypot(end->x_m, end->y_m), 1.0) << "the vehicle has not moved";
}

// Without the bus there are no wheels: the lidar goes on alone, and the state says so.
TEST_F(Drive, StatesGoToDegradedAndBackForTheLidarAndForTheBus) {
  std::string states = "initialising";
  for (const auto& change : run_["changes"]) {
    states += " " + change["to"].get<std::string>();
    std::printf("%7.2f s  %s -> %s (%s)\n", change["t_s"].get<double>(),
                change["from"].get<std::string>().c_str(), change["to"].get<std::string>().c_str(),
                change["reason"].get<std::string>().c_str());
  }
  EXPECT_EQ(states, "initialising tracking degraded tracking degraded tracking degraded tracking");
}

TEST_F(Drive, TheBusSaysThatTheLidarIsGoneAndWhenItIsBack) {
  const auto state_at = [this](double since_start_s) {
    HealthState state = HealthState::initialising;
    for (const Report& report : log_.reports()) {
      if (report.stamp_s <= start_s() + since_start_s) { state = report.state; }
    }
    return state;
  };
  EXPECT_EQ(state_at(31.5), HealthState::tracking);
  EXPECT_EQ(state_at(33.5), HealthState::degraded);
  EXPECT_EQ(state_at(36.5), HealthState::tracking);
  EXPECT_EQ(state_at(41.0), HealthState::tracking);
  EXPECT_EQ(state_at(48.0), HealthState::tracking);
}

TEST_F(Drive, NoPoseIsWrongSilently) {
  int in_a_row = 0;
  int worst_in_a_row = 0;
  std::size_t tracking = 0;
  for (const Report& report : log_.reports()) {
    const auto truth = truth_at(report.stamp_s);
    if (!truth || report.state != HealthState::tracking) { continue; }
    ++tracking;
    const bool wrong =
        std::hypot(report.map_T_base.x_m - truth->x_m, report.map_T_base.y_m - truth->y_m) >
            kSilentWrongM ||
        std::abs(turn(truth->theta_rad, report.map_T_base.theta_rad)) > kSilentWrongRad;
    in_a_row = wrong ? in_a_row + 1 : 0;
    worst_in_a_row = std::max(worst_in_a_row, in_a_row);
  }
  EXPECT_GT(tracking, 1500U);
  EXPECT_LT(worst_in_a_row, 3);
}

}  // namespace
}  // namespace picolo::test
