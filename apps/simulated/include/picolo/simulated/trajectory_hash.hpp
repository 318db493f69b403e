// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One number for what a controller published and for the map it made: the same on every platform.
#pragma once

#include <cstdint>

#include "picolo/core/hash.hpp"
#include "picolo/core/time.hpp"
#include "picolo/localisation/pose_estimate.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/simulated/simulated_controller.hpp"

namespace picolo::inline v0 {

/// Window and occupancy.
inline void add_map(const RollingMapCore& map, Hash& hash) {
  hash.add(static_cast<std::uint32_t>(map.window().origin_x_cells));
  hash.add(static_cast<std::uint32_t>(map.window().origin_y_cells));
  for (const std::int8_t cell : map.occupancy()) {
    hash.add(static_cast<std::uint32_t>(static_cast<std::uint8_t>(cell)));
  }
}

/// Every word of every publication; stamps relative to the start.
class TrajectoryHash {
 public:
  explicit TrajectoryHash(Timestamp start) : start_(start) {}
  void add(const PoseEstimate& estimate) {
    hash_.add(static_cast<std::int64_t>((estimate.stamp - start_).count()));
    for (const Pose2d* pose : {&estimate.map_T_base, &estimate.odom_T_base}) { add(*pose); }
    for (const float element : estimate.match_covariance.elements) { hash_.add(element); }
    for (const float element : estimate.drift_covariance.elements) { hash_.add(element); }
    hash_.add(static_cast<std::int64_t>(estimate.match_age.count()));
    hash_.add((static_cast<std::uint32_t>(estimate.state) << 8) |
              static_cast<std::uint32_t>(estimate.reason));
  }
  void add(const Pose2d& pose) {
    hash_.add(pose.x_m);
    hash_.add(pose.y_m);
    hash_.add(pose.theta_rad);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_.value(); }
  /// A word was not a number.
  [[nodiscard]] bool poisoned() const { return hash_.poisoned(); }

 private:
  Timestamp start_;
  Hash hash_{};
};

/// The drives of the committed hashes.
inline constexpr Duration kHashedDrive = 20s;
[[nodiscard]] inline sim::SimulationConfig hashed_drive(sim::SceneName scene,
                                                        Timestamp start = Timestamp{}) {
  return {.seed = 11, .start = start, .scene = sim::make_scene(scene)};
}

/// The hash of a file of hashes: of the trajectory's and the map's.
[[nodiscard]] inline std::uint64_t whole_hash(const TrajectoryHash& poses,
                                              const RollingMapCore& map) {
  Hash whole;
  whole.add(poses.value());
  add_map(map, whole);
  return whole.value();
}

}  // namespace picolo::inline v0
