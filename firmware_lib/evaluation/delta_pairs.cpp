// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/evaluation/delta_pairs.hpp"

#include <algorithm>
#include <numbers>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

using Poses = std::span<const Transform3d>;

/// Appends to the caller's span and remembers when it did not fit.
class PairList {
 public:
  explicit PairList(std::span<IndexPair> pairs) : pairs_(pairs) {}
  void add(std::size_t first, std::size_t second) {
    if (size_ == pairs_.size()) {
      overflowed_ = true;
      return;
    }
    pairs_[size_] = {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(second)};
    ++size_;
  }
  [[nodiscard]] Result<std::size_t> result() const {
    if (overflowed_) { return Status::full; }
    return size_;
  }

 private:
  std::span<IndexPair> pairs_;
  std::size_t size_ = 0;
  bool overflowed_ = false;
};

double step_m(Poses poses, std::size_t i) {
  return norm(difference(poses[i].translation_m, poses[i - 1].translation_m));
}

double angle_rad(Poses poses, std::size_t i, std::size_t j) {
  return rotation_angle_rad(product(transpose(poses[i].rotation), poses[j].rotation));
}

void by_frames(std::size_t count, const DeltaConfig& config, PairList& pairs) {
  const auto delta = static_cast<std::size_t>(floor_to_i32(config.delta, 1, 0x7FFFFFFF));
  for (std::size_t i = 0; i + delta < count; i += config.all_pairs ? 1 : delta) {
    pairs.add(i, i + delta);
  }
}

/// A pair ends, and the next one begins, wherever the way since the last such place reaches delta.
/// The start of the trajectory itself is no such place.
void by_consecutive_path(Poses poses, double delta_m, PairList& pairs) {
  bool started = false;
  std::size_t start = 0;
  double way_m = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    way_m += i == 0 ? 0.0 : step_m(poses, i);
    if (way_m < delta_m) { continue; }
    if (started) { pairs.add(start, i); }
    started = true;
    start = i;
    way_m = 0.0;
  }
}

void by_all_paths(std::span<const double> path_m, const DeltaConfig& config, PairList& pairs) {
  const double tolerance_m = config.delta * config.relative_tolerance;
  for (std::size_t i = 0; i + 1 < path_m.size(); ++i) {
    const auto miss_m = [&](std::size_t j) {
      return magnitude((path_m[j] - path_m[i]) - config.delta);
    };
    const auto from = path_m.begin() + static_cast<std::ptrdiff_t>(i) + 1;
    const auto reached = std::partition_point(
        from, path_m.end(), [&](double place_m) { return place_m - path_m[i] < config.delta; });
    auto best = static_cast<std::size_t>(reached - path_m.begin());
    if (best == path_m.size() || (best > i + 1 && miss_m(best - 1) <= miss_m(best))) { --best; }
    // A robot at rest repeats the same place: its first pose counts.
    best = static_cast<std::size_t>(std::lower_bound(from, path_m.end(), path_m[best]) -
                                    path_m.begin());
    if (miss_m(best) <= tolerance_m) { pairs.add(i, best); }
  }
}

void by_consecutive_angle(Poses poses, double delta_rad, PairList& pairs) {
  std::size_t start = 0;
  double turned_rad = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    turned_rad += angle_rad(poses, i - 1, i);
    if (turned_rad < delta_rad) { continue; }
    pairs.add(start, i);
    start = i;
    turned_rad = 0.0;
  }
}

void by_all_angles(Poses poses, double delta_rad, double tolerance_rad, PairList& pairs) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (std::size_t j = i + 1; j < poses.size(); ++j) {
      if (magnitude(angle_rad(poses, i, j) - delta_rad) <= tolerance_rad) { pairs.add(i, j); }
    }
  }
}

}  // namespace

Status accumulate_path(std::span<const Transform3d> poses, std::span<double> path_m) {
  if (poses.size() != path_m.size()) { return Status::invalid_argument; }
  double way_m = 0.0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    way_m += i == 0 ? 0.0 : step_m(poses, i);
    path_m[i] = way_m;
  }
  return Status::ok;
}

Result<std::size_t> select_pairs(std::span<const Transform3d> poses, const DeltaConfig& config,
                                 std::span<double> path_scratch, std::span<IndexPair> pairs) {
  if (!config.valid()) { return Status::invalid_argument; }
  PairList list{pairs};
  const double to_rad = config.unit == DeltaUnit::degrees ? std::numbers::pi / 180.0 : 1.0;
  switch (config.unit) {
    case DeltaUnit::frames: by_frames(poses.size(), config, list); break;
    case DeltaUnit::metres:
      if (!config.all_pairs) {
        by_consecutive_path(poses, config.delta, list);
        break;
      }
      if (accumulate_path(poses, path_scratch) != Status::ok) { return Status::invalid_argument; }
      by_all_paths(path_scratch, config, list);
      break;
    case DeltaUnit::degrees:
    case DeltaUnit::radians:
      if (config.all_pairs) {
        by_all_angles(poses, config.delta * to_rad,
                      config.delta * to_rad * config.relative_tolerance, list);
      } else {
        by_consecutive_angle(poses, config.delta * to_rad, list);
      }
      break;
  }
  return list.result();
}

}  // namespace picolo::inline v0
