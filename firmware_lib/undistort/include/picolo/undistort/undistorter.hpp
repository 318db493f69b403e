// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Moves every return of a sweep to where it was when it was measured.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/sensing/sweep.hpp"
#include "picolo/undistort/pose_buffer.hpp"

namespace picolo::inline v0 {

/// The instant at which the output frame stands.
enum class SweepReference : std::uint8_t { first_return, last_return, stamp };
/// The frame of the output points at that instant.
enum class SweepFrame : std::uint8_t { base, lidar };

struct UndistortConfig {
  Pose2f base_T_lidar{};
  RangeLimits limits{};
  SweepReference reference = SweepReference::last_return;
  Timestamp reference_stamp{};  ///< used with SweepReference::stamp
  SweepFrame frame = SweepFrame::base;
  Duration max_segment = 5ms;  ///< between two poses that are interpolated from the pose buffer
  [[nodiscard]] constexpr bool valid() const {
    return limits.valid() && max_segment > Duration{0} && max_segment <= Duration{5000};
  }
};

/// Points of one sweep in the frame B, structure of arrays for the matching kernels. A view; see
/// its owner for validity.
struct PointsView {
  std::span<const float> x_m;
  std::span<const float> y_m;
  /// Direction of the surface at each point, of length 127; (0, 0) where there is none to tell;
  /// both empty when nobody asked.
  std::span<const std::int8_t> along_x{};
  std::span<const std::int8_t> along_y{};
  [[nodiscard]] std::size_t size() const { return x_m.size(); }
};

/// The result of an undistortion. Only measurements become points: a range of 0, NaN, infinity or
/// outside of the limits stays out, however it would look after the transform.
struct UndistortedSweep {
  Timestamp reference{};       ///< the instant of frame B
  std::uint32_t sequence = 0;  ///< of the sweep
  Pose2d odom_T_base{};        ///< odometry at `reference`
  PointsView points{};         ///< in B, in the order of measurement
  Point2f lidar_at_first_m{};  ///< where the lidar stood in B at the first return of the sweep, ...
  Point2f lidar_at_last_m{};   ///< ... and at the last: ray origins of the map update lie between
  std::size_t invalid_returns = 0;
};

/// p = (odom_T_B)^-1 * odom_T_base(t_i) * base_T_lidar * p_i for every return, with poses at most
/// `max_segment` apart taken from the pose buffer and interpolated between, whatever the odometry's
/// rate. Bounded slices: `begin`, then `step` until `ok`. Context: cycle only.
class UndistorterCore {
 public:
  UndistorterCore(std::span<float> x_m, std::span<float> y_m) : x_m_(x_m), y_m_(y_m) {}

  /// Starts over with a sweep, which must stay valid until the last step.
  /// `invalid_argument`: configuration, or stamps and offsets that disagree. `full`: more returns
  /// than storage.
  Status begin(const UndistortConfig& config, const Sweep& sweep);

  /// Handles at most `max_returns` more returns. `ok`: the whole sweep is done and `result()` is
  /// valid until the next `begin`. `not_ready`: call again: either slices are left, or the poses do
  /// not cover the sweep's end or the reference yet (nothing was changed then). `out_of_range`: the
  /// sweep begins before the oldest pose; it cannot be undistorted, drop it. Cost: O(max_returns),
  /// one sin_cos a return and one pose interpolation a segment.
  Status step(const PoseBufferCore& poses, std::size_t max_returns);

  [[nodiscard]] const UndistortedSweep& result() const { return result_; }
  [[nodiscard]] bool busy() const { return busy_; }

 private:
  Status cover(const PoseBufferCore& poses);
  Status advance_segment(const PoseBufferCore& poses);
  void place(const RangeReturn& beam);

  std::span<float> x_m_;
  std::span<float> y_m_;
  UndistortConfig config_{};
  Sweep sweep_{};
  UndistortedSweep result_{};
  Pose2d reference_T_odom_{};
  // The current segment: B_T_lidar at both ends, and the ends in float seconds since the sweep's
  // start.
  Timestamp segment_start_{};
  Timestamp segment_end_{};
  Pose2f segment_from_{};
  Pose2f segment_to_{};
  float segment_turn_rad_ = 0.0F;
  float segment_start_s_ = 0.0F;
  float segment_end_s_ = 0.0F;
  float inverse_segment_per_s_ = 0.0F;
  std::size_t next_ = 0;
  std::size_t points_ = 0;
  bool busy_ = false;
  bool covered_ = false;
};

/// Storage: 8 bytes a return.
template <std::size_t Capacity>
class Undistorter {
 public:
  Undistorter() : core_(x_m_, y_m_) {}
  Undistorter(const Undistorter&) = delete;
  Undistorter& operator=(const Undistorter&) = delete;
  ~Undistorter() = default;

  Status begin(const UndistortConfig& config, const Sweep& sweep) {
    return core_.begin(config, sweep);
  }
  Status step(const PoseBufferCore& poses, std::size_t max_returns) {
    return core_.step(poses, max_returns);
  }
  [[nodiscard]] const UndistortedSweep& result() const { return core_.result(); }
  [[nodiscard]] bool busy() const { return core_.busy(); }

 private:
  std::array<float, Capacity> x_m_{};
  std::array<float, Capacity> y_m_{};
  UndistorterCore core_;
};

}  // namespace picolo::inline v0
