// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/scan_features.hpp"

#include <algorithm>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/vector3_inline.hpp"

namespace picolo::inline v0 {
namespace {

using inline3::add;
using inline3::dot3;
using inline3::mul;
using inline3::square;
using inline3::sub;

constexpr std::size_t kReach = 5;  // neighbours on each side

constexpr std::uint8_t kNoEdge = 1;     // hidden, grazing, or beside a gap
constexpr std::uint8_t kNoSurface = 2;  // beside a gap
constexpr std::uint8_t kTaken = 4;      // beside a feature that was chosen
constexpr std::uint8_t kEdge = 8;
constexpr std::uint8_t kStrong = 16;
constexpr std::uint8_t kInvalid = 32;

/// One ring and its work space, cut to its length.
struct Ring {
  std::span<const RingPoint> points;
  std::span<float> range_m;
  std::span<float> bend_m;
  std::span<std::uint16_t> order;
  std::span<std::uint8_t> flags;
  const FeatureConfig& config;

  [[nodiscard]] std::size_t size() const { return points.size(); }
  void mark(std::size_t from, std::size_t to, std::uint8_t flag) const {  // [from, to), clipped
    for (std::size_t i = from; i < std::min(to, size()); ++i) {
      flags[i] = static_cast<std::uint8_t>(flags[i] | flag);
    }
  }
  [[nodiscard]] bool has(std::size_t i, std::uint8_t flag) const { return (flags[i] & flag) != 0; }
};

std::size_t before(std::size_t i, std::size_t count) {
  return i > count ? i - count : 0;
}

void measure_ranges(const Ring& ring) {
  for (std::size_t i = 0; i < ring.size(); ++i) {
    ring.range_m[i] = square_root(square(ring.points[i].point_m));
    const bool good = ring.range_m[i] >= ring.config.min_range_m &&
                      ring.range_m[i] <= ring.config.max_range_m;  // false for NaN
    ring.flags[i] = good ? 0 : kInvalid;
  }
}

/// Is something missing between i and i + 1?
bool is_gap(const Ring& ring, std::size_t i, float cosine) {
  if (ring.has(i, kInvalid) || ring.has(i + 1, kInvalid)) { return true; }
  return dot3(ring.points[i].point_m, ring.points[i + 1].point_m) <
         cosine * ring.range_m[i] * ring.range_m[i + 1];
}

/// Points whose neighbourhood is not a piece of one surface that is well seen.
void mark_unreliable(const Ring& ring) {
  const FeatureConfig& config = ring.config;
  const float cosine = sin_cos(config.azimuth_gap_rad).cosine;
  ring.mark(0, kReach, kNoEdge | kNoSurface);
  ring.mark(before(ring.size(), kReach), ring.size(), kNoEdge | kNoSurface);
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    if (is_gap(ring, i, cosine)) {
      ring.mark(before(i + 1, kReach), i + 1 + kReach, kNoEdge | kNoSurface);
      continue;
    }
    const float step_m = ring.range_m[i + 1] - ring.range_m[i];
    if (step_m > config.depth_step_m) {
      ring.mark(i + 1, i + 1 + kReach, kNoEdge);  // the far side may be hidden by the near one
    } else if (step_m < -config.depth_step_m) {
      ring.mark(before(i + 1, kReach), i + 1, kNoEdge);
    }
  }
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const float grazing_m = config.parallel_share * ring.range_m[i];
    if (magnitude(ring.range_m[i] - ring.range_m[i - 1]) > grazing_m &&
        magnitude(ring.range_m[i + 1] - ring.range_m[i]) > grazing_m) {
      ring.mark(i, i + 1, kNoEdge | kNoSurface);
    }
  }
}

void measure_bends(const Ring& ring) {
  for (std::size_t i = kReach; i + kReach < ring.size(); ++i) {
    Vector3f total{};
    for (std::size_t k = i - kReach; k <= i + kReach; ++k) {
      total = add(total, ring.points[k].point_m);
    }
    const Vector3f off = sub(mul(total, 1.0F / 11.0F), ring.points[i].point_m);
    ring.bend_m[i] = 1.1F * square_root(square(off));
  }
}

/// Half of the way across the neighbourhood.
float reach_m(const Ring& ring, std::size_t i) {
  const Vector3f across = sub(ring.points[i + kReach].point_m, ring.points[i - kReach].point_m);
  return 0.5F * square_root(square(across));
}

struct Sector {
  std::size_t from;
  std::size_t to;
};

void choose_edges(const Ring& ring, Sector sector) {
  const FeatureConfig& config = ring.config;
  std::size_t count = 0;
  for (std::size_t i = sector.from; i < sector.to; ++i) {
    if (ring.has(i, kNoEdge) || !(ring.bend_m[i] > config.edge_bend_m) ||
        !(ring.bend_m[i] > config.edge_bend_share * reach_m(ring, i))) {
      continue;
    }
    ring.order[count] = static_cast<std::uint16_t>(i);
    ++count;
  }
  std::sort(ring.order.begin(), ring.order.begin() + static_cast<std::ptrdiff_t>(count),
            [&](std::uint16_t a, std::uint16_t b) {
              return ring.bend_m[a] != ring.bend_m[b] ? ring.bend_m[a] > ring.bend_m[b] : a < b;
            });
  std::size_t chosen = 0;
  for (std::size_t k = 0; k < count && chosen < config.edges; ++k) {
    const std::size_t i = ring.order[k];
    if (ring.has(i, kTaken)) { continue; }
    ring.mark(before(i, kReach), i + kReach + 1, kTaken);
    ring.mark(i, i + 1,
              static_cast<std::uint8_t>(kEdge | (chosen < config.strong_edges ? kStrong : 0)));
    ++chosen;
  }
}

bool is_surface(const Ring& ring, std::size_t i) {
  return !ring.has(i, kNoSurface) && !ring.has(i, kEdge) &&
         ring.bend_m[i] < ring.config.surface_bend_m;
}

/// The few flattest, apart from each other.
void choose_strong_surfaces(const Ring& ring, Sector sector) {
  for (std::size_t n = 0; n < ring.config.strong_surfaces; ++n) {
    std::size_t best = sector.to;
    for (std::size_t i = sector.from; i < sector.to; ++i) {
      if (is_surface(ring, i) && !ring.has(i, kTaken) &&
          (best == sector.to || ring.bend_m[i] < ring.bend_m[best])) {
        best = i;
      }
    }
    if (best == sector.to) { return; }
    ring.mark(before(best, kReach), best + kReach + 1, kTaken);
    ring.mark(best, best + 1, kStrong);
  }
}

Feature feature_of(const Ring& ring, std::size_t i, std::uint8_t number) {
  return {ring.points[i].point_m, ring.points[i].since_scan_start_s, number, ring.has(i, kStrong)};
}

/// Evenly along the way that the sector's surfaces cover, so that the budget reaches its end.
void add_surfaces(const Ring& ring, Sector sector, std::uint8_t number, FeatureList& surfaces) {
  const auto step_m = [&](std::size_t i) {
    return square_root(square(sub(ring.points[i].point_m, ring.points[i - 1].point_m)));
  };
  float way_m = 0.0F;
  for (std::size_t i = sector.from + 1; i < sector.to; ++i) {
    way_m += is_surface(ring, i) && is_surface(ring, i - 1) ? step_m(i) : 0.0F;
  }
  const float share_m = way_m / static_cast<float>(ring.config.surfaces);
  const float spacing_m = std::max(ring.config.surface_spacing_m, share_m);
  float since_last_m = spacing_m;
  std::size_t count = 0;
  for (std::size_t i = sector.from; i < sector.to && count < ring.config.surfaces; ++i) {
    since_last_m += i > sector.from ? step_m(i) : 0.0F;
    if (!is_surface(ring, i) || (!ring.has(i, kStrong) && since_last_m < spacing_m)) { continue; }
    since_last_m = 0.0F;
    ++count;
    (void)surfaces.add(feature_of(ring, i, number));
  }
}

}  // namespace

bool FeatureList::add(const Feature& feature) {
  if (size_ == storage_.size()) {
    ++dropped_;
    return false;
  }
  storage_[size_] = feature;
  ++size_;
  return true;
}

Status find_features(std::span<const RingPoint> ring_points, std::uint8_t number,
                     const FeatureConfig& config, const FeatureScratch& scratch, FeatureList& edges,
                     FeatureList& surfaces) {
  if (!config.valid()) { return Status::invalid_argument; }
  const std::size_t size = ring_points.size();
  if (size > scratch.range_m.size() || size > scratch.bend_m.size() ||
      size > scratch.order.size() || size > scratch.flags.size()) {
    return Status::full;
  }
  if (size <= 2 * kReach) { return Status::ok; }
  const Ring ring{ring_points,
                  scratch.range_m.first(size),
                  scratch.bend_m.first(size),
                  scratch.order.first(size),
                  scratch.flags.first(size),
                  config};
  measure_ranges(ring);
  mark_unreliable(ring);
  measure_bends(ring);
  const std::size_t inner = size - 2 * kReach;
  for (std::size_t s = 0; s < config.sectors; ++s) {
    const Sector sector{kReach + inner * s / config.sectors,
                        kReach + inner * (s + 1) / config.sectors};
    choose_edges(ring, sector);
    for (std::size_t i = sector.from; i < sector.to; ++i) {
      if (ring.has(i, kEdge)) { (void)edges.add(feature_of(ring, i, number)); }
    }
    choose_strong_surfaces(ring, sector);
    add_surfaces(ring, sector, number, surfaces);
  }
  return Status::ok;
}

}  // namespace picolo::inline v0
