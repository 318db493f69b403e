// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Sweeps of a hand-held lidar with the time of every return, and the same returns undistorted by
// somebody else. The motion is found from registering returns of the sweep's first and last moments
// with the undistorted cloud; then all others follow from it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "clouds.hpp"
#include "picolo/host/lidar_scans3.hpp"
#include "picolo/solve/pose_solver.hpp"
#include "support/data.hpp"

namespace picolo {
namespace {

struct Sweep {
  std::vector<Vector3d> raw_m;  ///< turned by 180 degrees about z
  std::vector<Vector3d> given_m;
  std::vector<double> share;  ///< of the sweep's duration
};

std::vector<float> floats_of(const std::filesystem::path& path) {
  std::vector<float> values(std::filesystem::file_size(path) / sizeof(float));
  std::ifstream file{path, std::ios::binary};
  file.read(reinterpret_cast<char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(float)));
  return values;
}

Sweep read_sweep(const std::string& number) {
  const auto path = [&](const char* kind) {
    return test::data_path("lidar3d/newer_06_undistort/" + std::string{kind} + "_" + number +
                           ".bin");
  };
  const auto times_s = floats_of(path("times"));
  const double end_s = static_cast<double>(*std::max_element(times_s.begin(), times_s.end()));
  Sweep sweep;
  for (const Vector3f& p : host::read_float_points(path("raw"), 3)) {
    sweep.raw_m.push_back(to_f64(Vector3f{-p.x, -p.y, p.z}));
  }
  for (const Vector3f& p : host::read_float_points(path("deskewed"), 3)) {
    sweep.given_m.push_back(to_f64(p));
  }
  for (const float t : times_s) { sweep.share.push_back(static_cast<double>(t) / end_s); }
  return sweep;
}

/// The rigid motion of the returns between two shares of the sweep, from their own correspondences:
/// three planes a point.
Pose3d registered(const Sweep& sweep, double from, double to) {
  std::vector<PlaneResidual<double>> planes;
  for (std::size_t i = 0; i < sweep.raw_m.size(); ++i) {
    if (sweep.share[i] < from || sweep.share[i] > to) { continue; }
    for (const Vector3d n : {Vector3d{1, 0, 0}, Vector3d{0, 1, 0}, Vector3d{0, 0, 1}}) {
      planes.push_back({sweep.raw_m[i], sweep.given_m[i], n});
    }
  }
  return PoseSolver<double>{{.max_iterations = 30}}.solve({planes, {}, {}}).pose;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

TEST(NewerUndistort, GivenTheMotionOfTheSweepThenReturnsComeToWhereTheyWereGiven) {
  PICOLO_NEED_DATA("lidar3d/newer_06_undistort/raw_00.bin");
  for (const std::string number : {"00", "01", "02"}) {
    const Sweep sweep = read_sweep(number);
    ASSERT_EQ(sweep.raw_m.size(), sweep.given_m.size());
    ASSERT_EQ(sweep.raw_m.size(), sweep.share.size());
    constexpr std::size_t kWindows = 10;
    std::vector<Pose3d> knots;
    for (std::size_t k = 0; k < kWindows; ++k) {
      const auto from = static_cast<double>(k) / kWindows;
      knots.push_back(registered(sweep, from, from + 1.0 / kWindows));
    }
    std::vector<double> untouched_m;
    std::vector<double> undistorted_m;
    for (std::size_t i = 0; i < sweep.raw_m.size(); ++i) {
      const double place = std::clamp(sweep.share[i] * kWindows - 0.5, 0.0, kWindows - 1.001);
      const auto knot = static_cast<std::size_t>(place);
      const Pose3d pose =
          interpolate(knots[knot], knots[knot + 1], place - static_cast<double>(knot));
      const Vector3d moved = transform(pose, sweep.raw_m[i]);
      undistorted_m.push_back(norm(difference(moved, sweep.given_m[i])));
      untouched_m.push_back(norm(difference(sweep.raw_m[i], sweep.given_m[i])));
    }
    std::printf("sweep %s: untouched %.3f m, undistorted %.4f m (medians)\n", number.c_str(),
                median(untouched_m), median(undistorted_m));
    EXPECT_GT(median(untouched_m), 0.1);
    EXPECT_LE(median(undistorted_m), 0.05);
  }
}

}  // namespace
}  // namespace picolo
