// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A log calibrates itself: PL-ICP between its scans is the reference for its own odometry; the map
// made by others only judges.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <vector>

#include "picolo/calibration/linear_batch.hpp"
#include "picolo/matching/plicp.hpp"
#include "support/data.hpp"
#include "support/gz_lines.hpp"

namespace picolo {
namespace {

struct KeyScan {
  Pose2d odometry;
  std::vector<float> x;
  std::vector<float> y;
};

/// FLASER n r*n x y theta ...: 180 beams from -90 deg.
std::vector<KeyScan> key_scans(const std::string& name) {
  std::vector<KeyScan> scans;
  for (const std::string& line : test::gz_lines(test::data_path(name))) {
    if (!line.starts_with("FLASER")) { continue; }
    const std::vector<double> v = test::numbers_in(line.substr(6));
    const auto beams = static_cast<std::size_t>(v[0]);
    KeyScan scan{{v[1 + beams], v[2 + beams], v[3 + beams]}, {}, {}};
    for (std::size_t k = 0; k < beams; ++k) {
      const double range = v[1 + k];
      if (range < 0.05 || range > 30.0) { continue; }
      const double bearing =
          std::numbers::pi * (static_cast<double>(k) / static_cast<double>(beams) - 0.5);
      scan.x.push_back(static_cast<float>(range * std::cos(bearing)));
      scan.y.push_back(static_cast<float>(range * std::sin(bearing)));
    }
    scans.push_back(scan);
  }
  return scans;
}

/// Root mean square distance after the best rotation and translation.
double ate(const std::vector<Pose2d>& path, const std::vector<std::vector<double>>& reference) {
  const auto n = static_cast<double>(path.size());
  double px = 0, py = 0, rx = 0, ry = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    px += path[k].x_m / n;
    py += path[k].y_m / n;
    rx += reference[k][1] / n;
    ry += reference[k][2] / n;
  }
  double c = 0, s = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const double x = path[k].x_m - px, y = path[k].y_m - py, u = reference[k][1] - rx,
                 v = reference[k][2] - ry;
    c += x * u + y * v;
    s += x * v - y * u;
  }
  const double theta = std::atan2(s, c);
  double squares = 0;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const double x = path[k].x_m - px, y = path[k].y_m - py, u = reference[k][1] - rx,
                 v = reference[k][2] - ry;
    squares += std::pow(std::cos(theta) * x - std::sin(theta) * y - u, 2) +
               std::pow(std::sin(theta) * x + std::cos(theta) * y - v, 2);
  }
  return std::sqrt(squares / n);
}

TEST(KeyScans, IntelCalibratedFromItsOwnScansReckonsFourTimesBetter) {
  PICOLO_NEED_DATA("radish/intel.clf.gz");
  const std::vector<KeyScan> scans = key_scans("radish/intel.clf.gz");
  std::vector<std::vector<double>> reference;
  for (const std::string& line : test::gz_lines(test::data_path("radish/intel_ref.tum.gz"))) {
    if (!line.empty() && line[0] != '#') { reference.push_back(test::numbers_in(line)); }
  }
  ASSERT_EQ(scans.size(), reference.size());
  const auto matcher = std::make_unique<PlIcpMatcher<512>>();
  std::vector<MotionPair> pairs;
  std::vector<Pose2d> raw{scans[0].odometry};
  for (std::size_t k = 1; k < scans.size(); ++k) {
    const Pose2d odometry = between(scans[k - 1].odometry, scans[k].odometry);
    const MatchReport report =
        matcher->match({scans[k - 1].x, scans[k - 1].y},
                       {.points = {scans[k].x, scans[k].y}, .start = to_f32(odometry)});
    if (report.outcome == MatchOutcome::converged) {
      pairs.push_back({odometry, to_f64(report.pose)});
    }
    raw.push_back(scans[k].odometry);
  }
  SpanSource<MotionPair> source{pairs};
  LinearReport report;
  ASSERT_EQ(calibrate_linear(source, {}, report), Status::ok);
  std::vector<Pose2d> corrected{{}};
  for (std::size_t k = 1; k < scans.size(); ++k) {
    const Pose2d step =
        corrected_by(report.correction, between(scans[k - 1].odometry, scans[k].odometry));
    corrected.push_back(corrected.back() * step);
  }
  const double before = ate(raw, reference);
  const double after = ate(corrected, reference);
  std::printf(
      "intel: odometry ATE %.2f m, calibrated from the log itself %.2f m (%zu of %zu matches, %llu "
      "used)\n",
      before, after, pairs.size(), scans.size() - 1,
      static_cast<unsigned long long>(report.samples));
  EXPECT_NEAR(before, 24.0, 0.1);
  EXPECT_LT(after, before / 4.0);
}

TEST(LinearBatch, RefusesAConfigurationThatIsNotValid) {
  SpanSource<MotionPair> source{{}};
  LinearReport report;
  EXPECT_EQ(calibrate_linear(source, {.quantile = 0.1}, report), Status::invalid_argument);
  EXPECT_EQ(calibrate_linear(source, {}, report), Status::degenerate);
}

}  // namespace
}  // namespace picolo
