// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Stamped odometry poses of the last moments: interpolates, never extrapolates.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0 {

struct StampedPose {
  Timestamp stamp{};
  Pose2d odom_T_base{};
};

/// The logic behind `PoseBuffer`, over storage it does not own. The oldest pose makes room for the
/// newest. Cost: `push` O(1), `at` O(log n). Context: cycle only.
class PoseBufferCore {
 public:
  explicit PoseBufferCore(std::span<StampedPose> storage);

  /// `out_of_range`: not later than the newest; the buffer is unchanged.
  Status push(const StampedPose& pose);
  void clear();

  /// odom_T_base at `stamp`, interpolated: translation linear, rotation along the shortest arc.
  /// `not_ready`: later than the newest pose; ask again when odometry has caught up.
  /// `out_of_range`: before the oldest pose; it will never be known.
  [[nodiscard]] Result<Pose2d> at(Timestamp stamp) const;

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Precondition: size() > 0.
  [[nodiscard]] const StampedPose& newest() const;
  [[nodiscard]] const StampedPose& oldest() const;

 private:
  [[nodiscard]] const StampedPose& by_age(std::size_t index) const;  // 0 is the oldest

  std::span<StampedPose> storage_;
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

/// Storage: 32 bytes a pose. At one pose per 5 ms frame 64 poses cover 0.32 s: a 10 Hz sweep and
/// its delays.
template <std::size_t Capacity>
class PoseBuffer {
 public:
  PoseBuffer() : core_(storage_) {}
  PoseBuffer(const PoseBuffer&) = delete;
  PoseBuffer& operator=(const PoseBuffer&) = delete;
  ~PoseBuffer() = default;

  Status push(const StampedPose& pose) { return core_.push(pose); }
  void clear() { core_.clear(); }
  [[nodiscard]] Result<Pose2d> at(Timestamp stamp) const { return core_.at(stamp); }
  [[nodiscard]] std::size_t size() const { return core_.size(); }
  [[nodiscard]] const PoseBufferCore& core() const { return core_; }

 private:
  std::array<StampedPose, Capacity> storage_{};
  PoseBufferCore core_;
};

}  // namespace picolo::inline v0
