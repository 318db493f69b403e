// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How the lidar moved from scan to scan, by point-to-line ICP in slices: the reference that a
/// calibration measures wheels against. Needs no map and no pose.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/matching/plicp.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

struct ScanOdometerConfig {
  /// Scans that follow sooner are left out: a longer way between two scans is seen better.
  Duration min_interval = 150ms;
  /// A longer gap is not bridged: wheels do not keep their rates for so long.
  Duration max_interval = 500ms;
  /// Of one slice, see PlIcpMatcherCore::step_slice: about an iteration with 360 points.
  std::size_t max_looks = 10'000;
  [[nodiscard]] constexpr bool valid() const {
    return min_interval >= Duration{0} && max_interval > min_interval && max_looks > 0;
  }
};

/// Two scans in the lidar's own frame. All spans of one size, and that of the matcher's storage.
struct ScanOdometerStorage {
  std::array<std::span<float>, 2> x_m;
  std::array<std::span<float>, 2> y_m;
};

/// Motion of the lidar in its own frame, begin_T_end.
struct ScanDisplacement {
  Timestamp begin{};
  Timestamp end{};
  Pose2d motion{};
};

struct ScanOdometerCounters {
  std::uint32_t matched = 0;
  std::uint32_t failed = 0;
  std::uint32_t skipped = 0;  ///< offered while a match was under way, or too soon
};

/// Cost: `offer` O(points); a `step` is a slice of a match, see `max_looks`. Context: cycle only.
class ScanOdometerCore {
 public:
  /// What is referred to outlives this. `matcher` is used by nobody else.
  ScanOdometerCore(const ScanOdometerConfig& config, const ScanOdometerStorage& storage,
                   PlIcpMatcherCore& matcher)
      : config_(config), storage_(storage), matcher_(matcher) {}

  /// Points of one instant in base. More than the storage holds are thinned out evenly. Odometry is
  /// where the match begins; nothing of it enters the result.
  void offer(const PointsView& points, Timestamp stamp, const Pose2d& odom_T_base,
             const Pose2d& base_T_lidar);
  /// One slice. False when there is nothing to do.
  bool step();
  /// The newest displacement, once. False: none since the last call.
  [[nodiscard]] bool take(ScanDisplacement& displacement);
  void reset();
  [[nodiscard]] const ScanOdometerCounters& counters() const { return counters_; }

 private:
  enum class Stage : std::uint8_t { empty, reference, begin, iterate };
  struct Scan {
    std::size_t size = 0;
    Timestamp stamp{};
    Pose2d odom_T_lidar{};
  };
  [[nodiscard]] PointsView view(std::size_t index) const;
  void keep(const PointsView& points, Scan& scan, std::size_t index, const Pose2d& base_T_lidar);
  void conclude();

  ScanOdometerConfig config_;
  ScanOdometerStorage storage_;
  PlIcpMatcherCore& matcher_;
  std::array<Scan, 2> scans_{};
  std::size_t reference_ = 0;  // index of the earlier scan
  Stage stage_ = Stage::empty;
  ScanDisplacement result_{};
  bool fresh_ = false;
  ScanOdometerCounters counters_{};
};

/// Storage: 58 bytes a point. A match takes the longer the more points there are: choose as many
/// as one iteration fits into the background's budget.
template <std::size_t Capacity>
class ScanOdometer {
 public:
  explicit ScanOdometer(const ScanOdometerConfig& config = {}, const PlIcpConfig& matcher = {})
      : matcher_(matcher),
        core_(config, {{x_m_[0], x_m_[1]}, {y_m_[0], y_m_[1]}}, matcher_.core()) {}
  ScanOdometer(const ScanOdometer&) = delete;
  ScanOdometer& operator=(const ScanOdometer&) = delete;
  ~ScanOdometer() = default;
  [[nodiscard]] ScanOdometerCore& core() { return core_; }
  [[nodiscard]] const ScanOdometerCore& core() const { return core_; }

 private:
  std::array<std::array<float, Capacity>, 2> x_m_{};
  std::array<std::array<float, Capacity>, 2> y_m_{};
  PlIcpMatcher<Capacity> matcher_;
  ScanOdometerCore core_;
};

}  // namespace picolo::inline v0
