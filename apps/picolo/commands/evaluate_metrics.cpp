// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "commands/evaluate_metrics.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "picolo/evaluation/association.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

using host::ExitCode;
using host::UserError;

PosePairs paired_by_number(const host::SpatialTrajectory& reference,
                           const host::SpatialTrajectory& estimate) {
  if (reference.poses.size() != estimate.poses.size()) {
    throw UserError{ExitCode::input, estimate.name,
                    fmt::format("has {} poses, its reference {}", estimate.poses.size(),
                                reference.poses.size()),
                    "without stamps poses are compared by number: give files of one length"};
  }
  PosePairs pairs{{}, false, reference.poses, estimate.poses};
  for (std::size_t i = 0; i < pairs.estimate.size(); ++i) {
    pairs.stamps_s.push_back(static_cast<double>(i));
  }
  return pairs;
}

void pair_nearest(const host::SpatialTrajectory& reference, const host::SpatialTrajectory& estimate,
                  const EvaluateSettings& settings, PosePairs& pairs) {
  std::vector<IndexPair> indices(std::min(reference.poses.size(), estimate.poses.size()));
  const auto count = associate(reference.stamps_s, estimate.stamps_s, settings.max_difference_s,
                               settings.offset_s, indices);
  for (std::size_t i = 0; i < count.value_or(0); ++i) {
    pairs.stamps_s.push_back(estimate.stamps_s[indices[i].second]);
    pairs.reference.push_back(reference.poses[indices[i].first]);
    pairs.estimate.push_back(estimate.poses[indices[i].second]);
  }
}

void pair_interpolated(const host::SpatialTrajectory& reference,
                       const host::SpatialTrajectory& estimate, const EvaluateSettings& settings,
                       PosePairs& pairs) {
  for (std::size_t i = 0; i < estimate.poses.size(); ++i) {
    const double stamp_s = estimate.stamps_s[i] + settings.offset_s;
    const auto pose = pose_at(reference.stamps_s, reference.poses, stamp_s);
    if (!pose) { continue; }
    pairs.stamps_s.push_back(estimate.stamps_s[i]);
    pairs.reference.push_back(*pose);
    pairs.estimate.push_back(estimate.poses[i]);
  }
}

ErrorStatistics statistics_or_throw(const std::vector<double>& errors, const std::string& name) {
  std::vector<double> sorted = errors;
  const auto statistics = statistics_of(sorted);
  if (!statistics) {
    throw UserError{ExitCode::refused, name, "no error could be computed from it",
                    "a larger trajectory or a smaller --delta gives pairs to compare"};
  }
  return *statistics;
}

/// Angles with all pairs give up to n (n - 1) / 2 of them; grown until they fit.
std::vector<IndexPair> pairs_of(const std::vector<Transform3d>& poses, const DeltaConfig& config,
                                const std::string& name) {
  std::vector<double> path_m(poses.size());
  std::vector<IndexPair> pairs(poses.size());
  for (;;) {
    const auto count = select_pairs(poses, config, path_m, pairs);
    if (count) {
      pairs.resize(*count);
      return pairs;
    }
    if (count.status() != Status::full) {
      throw UserError{ExitCode::usage, name, fmt::format("delta {} is not possible", config.delta),
                      "--delta is positive, and at least 1 in frames"};
    }
    pairs.resize(2 * pairs.size());
  }
}

}  // namespace

PosePairs paired(const host::SpatialTrajectory& reference, const host::SpatialTrajectory& estimate,
                 const EvaluateSettings& settings) {
  if (reference.stamps_s.empty() != estimate.stamps_s.empty()) {
    throw UserError{ExitCode::input, estimate.name,
                    fmt::format("and {}: one has stamps, the other has none", reference.name),
                    "convert one of them, so that both are KITTI or both have stamps"};
  }
  if (estimate.stamps_s.empty()) { return paired_by_number(reference, estimate); }
  PosePairs pairs;
  pairs.stamped = true;
  if (settings.interpolate) {
    pair_interpolated(reference, estimate, settings, pairs);
  } else {
    pair_nearest(reference, estimate, settings, pairs);
  }
  if (pairs.estimate.empty()) {
    throw UserError{
        ExitCode::input, estimate.name,
        fmt::format("no pose is within {:g} s of one of {} (stamps {:.3f} to {:.3f} s against "
                    "{:.3f} to {:.3f} s)",
                    settings.max_difference_s, reference.name, estimate.stamps_s.front(),
                    estimate.stamps_s.back(), reference.stamps_s.front(),
                    reference.stamps_s.back()),
        "check the clocks, or give --offset or a larger --max-diff"};
  }
  return pairs;
}

Alignment align_pairs(PosePairs& pairs, AlignmentKind kind, const std::string& name) {
  const auto alignment = find_alignment(pairs.reference, pairs.estimate, kind);
  if (!alignment) {
    throw UserError{
        ExitCode::refused, name,
        fmt::format("its {} positions do not determine the alignment", pairs.estimate.size()),
        "use --align se2, origin or none for a trajectory on one line or at rest"};
  }
  if (kind != AlignmentKind::none) { align(*alignment, pairs.estimate); }
  return *alignment;
}

EvaluateResult evaluate_ape(PosePairs& pairs, const EvaluateSettings& settings,
                            const std::string& name) {
  EvaluateResult result;
  result.alignment = align_pairs(pairs, settings.alignment, name);
  result.errors.resize(pairs.estimate.size());
  (void)absolute_errors(pairs.reference, pairs.estimate, settings.relation, result.errors);
  result.stamps_s = pairs.stamps_s;
  result.at = pairs.estimate;
  result.statistics = statistics_or_throw(result.errors, name);
  return result;
}

EvaluateResult evaluate_rpe(PosePairs& pairs, const EvaluateSettings& settings,
                            const std::string& name) {
  EvaluateResult result;
  result.alignment = align_pairs(pairs, settings.alignment, name);
  const auto indices = pairs_of(pairs.estimate, settings.delta, name);
  result.errors.resize(indices.size());
  (void)relative_errors(pairs.reference, pairs.estimate, indices, settings.relation, result.errors);
  for (const auto [from, to] : indices) {
    result.stamps_s.push_back(pairs.stamps_s[to]);
    result.at.push_back(pairs.estimate[to]);
  }
  result.statistics = statistics_or_throw(result.errors, name);
  return result;
}

SegmentReport evaluate_segments(const PosePairs& pairs, const std::string& name) {
  std::vector<double> path_m(pairs.reference.size());
  const auto report = segment_errors(pairs.reference, pairs.estimate, {}, path_m);
  if (!report) {
    throw UserError{ExitCode::refused, name,
                    fmt::format("its way of {:.1f} m holds no stretch of 100 m",
                                path_m.empty() ? 0.0 : path_m.back()),
                    "use 'picolo evaluate rpe' with a shorter --delta"};
  }
  return *report;
}

}  // namespace picolo::tool
