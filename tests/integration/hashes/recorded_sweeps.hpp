// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Recorded logs of the committed hashes as the localiser takes them: each scan as one instant.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "picolo/core/math.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/host/carmen.hpp"
#include "picolo/sensing/sweep.hpp"
#include "support/data.hpp"

namespace picolo::test {

struct RecordedSweep {
  Pose2d odom_T_base;
  std::vector<float> x_m;  ///< in base
  std::vector<float> y_m;
};

/// The first `count` scans of `name`.clf.gz.
inline std::vector<RecordedSweep> recorded_sweeps(const std::string& name, std::size_t count) {
  host::LineReader reader{data_path(name + ".clf.gz").string()};
  host::Diagnostics silent{[](std::string_view) {}};
  const host::CarmenLog log = host::read_carmen(reader, silent);
  std::vector<RecordedSweep> sweeps(std::min(count, log.scans.size()));
  for (std::size_t i = 0; i < sweeps.size(); ++i) {
    const host::LogScan& scan = log.scans[i];
    sweeps[i].odom_T_base = scan.odom_T_base;
    for (std::size_t k = 0; k < scan.ranges_m.size(); ++k) {
      if (!RangeLimits{}.contains(scan.ranges_m[k])) { continue; }
      const SinCos<float> direction = sin_cos(scan.bearings_rad[k]);
      const Point2f p = transform(to_f32(scan.base_T_lidar), {scan.ranges_m[k] * direction.cosine,
                                                              scan.ranges_m[k] * direction.sine});
      sweeps[i].x_m.push_back(p.x_m);
      sweeps[i].y_m.push_back(p.y_m);
    }
  }
  return sweeps;
}

}  // namespace picolo::test
