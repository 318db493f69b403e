// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The clocks of three recorded drives from ticks and scans alone: point-to-line ICP gives the
// rotation of the lidar, the lag regression does the rest. The lidar records are 0.145 to 0.155 s
// older than the counters stored with them.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "picolo/calibration/time_offset.hpp"
#include "picolo/matching/plicp.hpp"
#include "support/data.hpp"
#include "support/gz_lines.hpp"

namespace picolo {
namespace {

struct Points {
  std::vector<float> x;
  std::vector<float> y;
};

/// ROBOTLASER1 type start fov res max accuracy remission n r*n n_rem rem*n_rem 11 numbers stamp ...
Points points_of(const std::vector<double>& v, double& stamp_s) {
  Points points;
  const auto beams = static_cast<std::size_t>(v[7]);
  for (std::size_t k = 0; k < beams; ++k) {
    const double range = v[8 + k];
    if (range < 0.06 || range > 5.5) { continue; }
    const double bearing = v[1] + static_cast<double>(k) * v[3];
    points.x.push_back(static_cast<float>(range * std::cos(bearing)));
    points.y.push_back(static_cast<float>(range * std::sin(bearing)));
  }
  const auto remissions = static_cast<std::size_t>(v[8 + beams]);
  stamp_s = v[8 + beams + 1 + remissions + 11];
  return points;
}

class RecordedDrive : public ::testing::TestWithParam<const char*> {};

TEST_P(RecordedDrive, TimeOffsetComesFromTicksAndScansAlone) {
  const std::string name = std::string{"raw2d/mines_"} + GetParam() + ".clf.gz";
  PICOLO_NEED_DATA(name);
  auto estimator = std::make_unique<TimeOffset<101, 64>>();
  auto matcher = std::make_unique<PlIcpMatcher<1024>>();
  Points before;
  double before_s = 0.0;
  Pose2f guess{};
  for (const std::string& line : test::gz_lines(test::data_path(name))) {
    if (line.starts_with("TICKS")) {
      const std::vector<double> v = test::numbers_in(line.substr(5));
      constexpr double kTick = 2.0 * std::numbers::pi / 2000.0;
      static_cast<void>(estimator->core().add_wheels({v[0], kTick * v[1], kTick * v[2]}));
    } else if (line.starts_with("ROBOTLASER1")) {
      double stamp_s = 0.0;
      const Points now = points_of(test::numbers_in(line.substr(11)), stamp_s);
      if (!before.x.empty()) {
        const MatchReport report =
            matcher->match({before.x, before.y}, {.points = {now.x, now.y}, .start = guess});
        const bool usable =
            report.outcome == MatchOutcome::converged || report.outcome == MatchOutcome::degenerate;
        guess = usable ? report.pose : Pose2f{};
        if (usable) {
          static_cast<void>(estimator->core().add_rotation(
              before_s, stamp_s, static_cast<double>(report.pose.theta_rad)));
        }
      }
      before = now;
      before_s = stamp_s;
    }
  }
  TimeOffsetReport report;
  ASSERT_EQ(estimator->core().solve(report), Status::ok) << to_string(report.refusal.reason);
  std::printf(
      "%s: lidar records are %.4f +- %.4f s old, %.1f %% explained, %llu intervals, %llu "
      "rejected\n",
      GetParam(), report.offset_s.value, report.offset_s.std, 100.0 * report.explained,
      static_cast<unsigned long long>(report.intervals),
      static_cast<unsigned long long>(report.rejected));
  EXPECT_NEAR(report.offset_s.value, 0.150, 0.02);
}

INSTANTIATE_TEST_SUITE_P(Mines, RecordedDrive, ::testing::Values("exp1", "exp2", "testlab"));

}  // namespace
}  // namespace picolo
