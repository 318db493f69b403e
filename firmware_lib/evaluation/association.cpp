// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/evaluation/association.hpp"

#include <algorithm>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

using Stamps = std::span<const double>;

double distance_s(double a, double b) {
  return a < b ? b - a : a - b;
}

/// Index of the stamp nearest to `stamp_s` after `offset_s` was added to all; the first one on a
/// tie.
std::size_t nearest(Stamps stamps_s, double offset_s, double stamp_s) {
  const auto reached = std::partition_point(stamps_s.begin(), stamps_s.end(),
                                            [&](double s) { return s + offset_s < stamp_s; });
  auto best = static_cast<std::size_t>(reached - stamps_s.begin());
  const auto miss_s = [&](std::size_t i) { return distance_s(stamps_s[i] + offset_s, stamp_s); };
  if (best == stamps_s.size() || (best > 0 && miss_s(best - 1) <= miss_s(best))) { --best; }
  return static_cast<std::size_t>(
      std::lower_bound(stamps_s.begin(), stamps_s.end(), stamps_s[best]) - stamps_s.begin());
}

}  // namespace

Result<std::size_t> associate(std::span<const double> reference_stamps_s,
                              std::span<const double> estimate_stamps_s, double max_difference_s,
                              double estimate_offset_s, std::span<IndexPair> pairs) {
  if (!std::is_sorted(reference_stamps_s.begin(), reference_stamps_s.end()) ||
      !std::is_sorted(estimate_stamps_s.begin(), estimate_stamps_s.end()) ||
      !(max_difference_s >= 0.0)) {
    return Status::invalid_argument;
  }
  const bool estimate_longer = estimate_stamps_s.size() > reference_stamps_s.size();
  const Stamps shorter = estimate_longer ? reference_stamps_s : estimate_stamps_s;
  const Stamps longer = estimate_longer ? estimate_stamps_s : reference_stamps_s;
  const double longer_offset_s = estimate_longer ? estimate_offset_s : -estimate_offset_s;
  if (longer.empty()) { return std::size_t{0}; }
  std::size_t count = 0;
  for (std::size_t i = 0; i < shorter.size(); ++i) {
    const std::size_t j = nearest(longer, longer_offset_s, shorter[i]);
    if (distance_s(longer[j] + longer_offset_s, shorter[i]) > max_difference_s) { continue; }
    if (count == pairs.size()) { return Status::full; }
    const auto in_shorter = static_cast<std::uint32_t>(i);
    const auto in_longer = static_cast<std::uint32_t>(j);
    pairs[count] =
        estimate_longer ? IndexPair{in_shorter, in_longer} : IndexPair{in_longer, in_shorter};
    ++count;
  }
  return count;
}

Result<Transform3d> pose_at(std::span<const double> stamps_s, std::span<const Transform3d> poses,
                            double stamp_s) {
  if (stamps_s.size() != poses.size()) { return Status::invalid_argument; }
  if (stamps_s.empty() || !(stamp_s >= stamps_s.front() && stamp_s <= stamps_s.back())) {
    return Status::out_of_range;
  }
  const auto after = std::upper_bound(stamps_s.begin(), stamps_s.end(), stamp_s);
  const auto to = static_cast<std::size_t>(after - stamps_s.begin());
  const std::size_t from = to - 1;
  if (stamps_s[from] == stamp_s) { return poses[from]; }
  const double share = (stamp_s - stamps_s[from]) / (stamps_s[to] - stamps_s[from]);
  return to_transform(interpolate(to_pose(poses[from]), to_pose(poses[to]), share));
}

}  // namespace picolo::inline v0
