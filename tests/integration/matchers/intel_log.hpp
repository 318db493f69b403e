// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Scans of the Intel lab and human-verified motions between pairs of them.
#pragma once

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "picolo/geometry/pose2.hpp"
#include "picolo/undistort/undistorter.hpp"
#include "support/data.hpp"
#include "support/gz_lines.hpp"

namespace picolo::test {

inline constexpr const char* kIntelLog = "raw2d/intel_corrected_rt.clf.gz";
inline constexpr const char* kIntelPairs = "raw2d/intel_pairs.txt";

struct PlainScan {
  std::vector<float> x_m;
  std::vector<float> y_m;
  [[nodiscard]] PointsView view() const { return {x_m, y_m}; }
};

/// ROBOTLASER1 type start fov res max accuracy remission n r*n ...; ranges of 30 m and more are no
/// returns.
inline std::vector<PlainScan> intel_scans() {
  std::vector<PlainScan> scans;
  for (const std::string& line : gz_lines(data_path(kIntelLog))) {
    if (!line.starts_with("ROBOTLASER1 ")) { continue; }
    const std::vector<double> v = numbers_in(line.substr(12));
    PlainScan scan;
    const auto n = static_cast<std::size_t>(v[7]);
    for (std::size_t k = 0; k < n; ++k) {
      const double range = v[8 + k];
      const double bearing = v[1] + v[3] * static_cast<double>(k);
      if (range <= 0.0 || range >= 30.0) { continue; }
      scan.x_m.push_back(static_cast<float>(range * std::cos(bearing)));
      scan.y_m.push_back(static_cast<float>(range * std::sin(bearing)));
    }
    scans.push_back(scan);
  }
  return scans;
}

struct IntelPair {
  std::size_t reference = 0;
  std::size_t scan = 0;
  Pose2d reference_T_scan{};
};

inline std::vector<IntelPair> intel_pairs() {
  std::vector<IntelPair> pairs;
  std::ifstream file{data_path(kIntelPairs)};
  std::string line;
  while (std::getline(file, line)) {
    if (line.starts_with("#")) { continue; }
    const std::vector<double> v = numbers_in(line);
    if (v.size() < 5) { continue; }
    pairs.push_back(
        {static_cast<std::size_t>(v[0]), static_cast<std::size_t>(v[1]), {v[2], v[3], v[4]}});
  }
  return pairs;
}

}  // namespace picolo::test
