// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Trajectory files that a command left.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "picolo/geometry/pose2.hpp"
#include "support/files.hpp"

namespace picolo::test {

inline std::vector<std::string> first_fields(const std::string& text) {
  std::vector<std::string> fields;
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    fields.push_back(line.substr(0, line.find(' ')));
  }
  return fields;
}

/// A file of the default output folder.
inline std::string out(const TemporaryFolder& folder, const std::string& name) {
  return content_of(folder.path() / "picolo-out" / name);
}

struct Poses {
  std::vector<std::string> stamps;
  std::vector<Pose2d> poses;
};

inline Poses poses_of(const std::string& tum) {
  Poses result;
  std::istringstream lines{tum};
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields{line};
    std::string stamp;
    double x = 0.0, y = 0.0, z = 0.0, qx = 0.0, qy = 0.0, qz = 0.0, qw = 1.0;
    fields >> stamp >> x >> y >> z >> qx >> qy >> qz >> qw;
    result.stamps.push_back(stamp);
    result.poses.push_back({x, y, 2.0 * std::atan2(qz, qw)});
  }
  return result;
}

inline void expect_close(const std::string& one, const std::string& other, double limit_m,
                         double limit_rad) {
  const Poses a = poses_of(one);
  const Poses b = poses_of(other);
  ASSERT_EQ(a.stamps, b.stamps);
  ASSERT_FALSE(a.poses.empty());
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    const Pose2d off = between(a.poses[i], b.poses[i]);
    EXPECT_LE(std::hypot(off.x_m, off.y_m), limit_m) << "scan " << i;
    EXPECT_LE(std::abs(std::remainder(off.theta_rad, 2.0 * std::numbers::pi)), limit_rad)
        << "scan " << i;
  }
}

}  // namespace picolo::test
