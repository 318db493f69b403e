// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A short drive of a 16-ring lidar through a yard of walls and containers, made up from nothing:
/// for hashes and for boards that have no recording at hand.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/random.hpp"
#include "picolo/geometry/se3.hpp"
#include "picolo/odometry/scan_features.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kYardRings = 16;
inline constexpr std::size_t kYardAzimuths = 600;
inline constexpr std::size_t kYardScans = 12;

/// Every return is measured at its own instant from a lidar that drives a curve, with 1 cm of
/// noise. Deterministic. Cost: one cast against seven boxes a return. No heap.
class Yard {
 public:
  explicit Yard(std::uint64_t seed) : random_(seed) {}

  /// One ring of a scan; rings of a scan in any order give different noise, so ask for them in
  /// order.
  void measure(std::size_t scan, std::size_t ring, std::array<RingPoint, kYardAzimuths>& points);
  /// Where the lidar is, scans and parts of a scan after the start; there it is the identity.
  [[nodiscard]] static Pose3d start_T_lidar(double scans);

 private:
  Random random_;
};

}  // namespace picolo::inline v0
