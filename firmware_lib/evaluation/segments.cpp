// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/evaluation/segments.hpp"

#include <algorithm>

#include "picolo/core/number_model.hpp"
#include "picolo/evaluation/delta_pairs.hpp"
#include "picolo/evaluation/pose_error.hpp"

namespace picolo::inline v0 {
namespace {

void add(SegmentDrift& drift, double translation_share, double rotation_rad_per_m) {
  drift.translation_share += translation_share;
  drift.rotation_rad_per_m += rotation_rad_per_m;
  ++drift.count;
}

void average(SegmentDrift& drift) {
  if (drift.count == 0) { return; }
  drift.translation_share /= static_cast<double>(drift.count);
  drift.rotation_rad_per_m /= static_cast<double>(drift.count);
}

}  // namespace

Result<SegmentReport> segment_errors(std::span<const Transform3d> reference,
                                     std::span<const Transform3d> estimate,
                                     const SegmentConfig& config,
                                     std::span<double> path_scratch_m) {
  if (reference.size() != estimate.size() || config.step_frames == 0 ||
      accumulate_path(reference, path_scratch_m) != Status::ok) {
    return Status::invalid_argument;
  }
  SegmentReport report;
  for (std::size_t from = 0; from < reference.size(); from += config.step_frames) {
    for (std::size_t k = 0; k < kSegmentLengths; ++k) {
      const double length_m = config.lengths_m[k];
      const auto end = std::upper_bound(path_scratch_m.begin(), path_scratch_m.end(),
                                        path_scratch_m[from] + length_m);
      if (end == path_scratch_m.end()) { continue; }
      const auto to = static_cast<std::size_t>(end - path_scratch_m.begin());
      const auto error = [&](PoseRelation relation) {
        return relative_error(reference[from], reference[to], estimate[from], estimate[to],
                              relation) /
               length_m;
      };
      const double translation_share = error(PoseRelation::translation);
      const double rotation_rad_per_m = error(PoseRelation::rotation_rad);
      add(report.by_length[k], translation_share, rotation_rad_per_m);
      add(report.overall, translation_share, rotation_rad_per_m);
    }
  }
  if (report.overall.count == 0) { return Status::not_ready; }
  for (SegmentDrift& drift : report.by_length) { average(drift); }
  average(report.overall);
  return report;
}

}  // namespace picolo::inline v0
