// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/feature_index.hpp"

#include <algorithm>
#include <numbers>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/vector3_inline.hpp"

namespace picolo::inline v0 {

FeatureIndex::FeatureIndex(std::span<std::uint16_t> starts, std::span<std::uint16_t> order,
                           std::size_t rings)
    : starts_(starts), order_(order), rings_(rings), bins_((starts.size() - 1) / rings) {}

std::size_t FeatureIndex::bin_of(const Vector3f& p) const {
  constexpr float kPerTurn = 0.5F / std::numbers::pi_v<float>;
  const float turn = arc_tangent2(p.y, p.x) * kPerTurn + 0.5F;
  const auto last = static_cast<std::int32_t>(bins_) - 1;
  return static_cast<std::size_t>(floor_to_i32(turn * static_cast<float>(bins_), 0, last));
}

Status FeatureIndex::build(std::span<const Feature> features) {
  features_ = {};
  for (std::uint16_t& start : starts_) { start = 0; }
  if (features.size() > order_.size() || features.size() >= kNone) { return Status::full; }
  const auto slot = [&](const Feature& f) {
    return std::min<std::size_t>(f.ring, rings_ - 1) * bins_ + bin_of(f.point_m);
  };
  for (const Feature& f : features) { ++starts_[slot(f) + 1]; }
  for (std::size_t i = 1; i < starts_.size(); ++i) {
    starts_[i] = static_cast<std::uint16_t>(starts_[i] + starts_[i - 1]);
  }
  // Filling moves every start to its end; from the back, so that each bin keeps the features'
  // order.
  for (std::size_t i = features.size(); i-- > 0;) {
    std::uint16_t& end = starts_[slot(features[i]) + 1];
    --end;
    order_[end] = static_cast<std::uint16_t>(i);
  }
  for (std::size_t i = 1; i < starts_.size(); ++i) { starts_[i - 1] = starts_[i]; }
  starts_.back() = static_cast<std::uint16_t>(features.size());
  features_ = features;
  return Status::ok;
}

std::size_t FeatureIndex::nearest(const Vector3f& p, std::size_t ring, std::size_t ring_reach,
                                  RingChoice choice, float radius_m, std::size_t except) const {
  const float range_m = hypotenuse(p.x, p.y);
  // The bins that a circle of this radius around p touches: its half angle is at most radius /
  // range times pi / 2.
  const auto half = static_cast<std::int32_t>(bins_ / 2);
  const std::int32_t reach =
      range_m > radius_m
          ? 1 + floor_to_i32(0.25F * static_cast<float>(bins_) * radius_m / range_m, 0, half)
          : half;
  const std::size_t first_ring =
      choice == RingChoice::same ? ring : (ring > ring_reach ? ring - ring_reach : 0);
  const std::size_t last_ring =
      choice == RingChoice::same ? ring : std::min(ring + ring_reach, rings_ - 1);
  const auto centre = static_cast<std::int32_t>(bin_of(p));
  const auto bins = static_cast<std::int32_t>(bins_);
  const std::int32_t span = std::min(2 * reach + 1, bins);
  std::size_t best = kNone;
  float best_m2 = radius_m * radius_m;
  for (std::size_t r = first_ring; r <= last_ring && r < rings_; ++r) {
    if (choice == RingChoice::other && r == ring) { continue; }
    for (std::int32_t b = 0; b < span; ++b) {
      const auto bin = static_cast<std::size_t>((centre - reach + b + bins) % bins);
      const std::size_t at = r * bins_ + bin;
      for (std::size_t k = starts_[at]; k < starts_[at + 1]; ++k) {
        const std::size_t i = order_[k];
        const float m2 = inline3::square(inline3::sub(features_[i].point_m, p));
        if (i != except && m2 < best_m2) {
          best_m2 = m2;
          best = i;
        }
      }
    }
  }
  return best;
}

}  // namespace picolo::inline v0
