// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/undistort/pose_buffer.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

PoseBufferCore::PoseBufferCore(std::span<StampedPose> storage) : storage_(storage) {}

Status PoseBufferCore::push(const StampedPose& pose) {
  if (size_ > 0 && pose.stamp <= newest().stamp) { return Status::out_of_range; }
  storage_[next_] = pose;
  next_ = next_ + 1 == storage_.size() ? 0 : next_ + 1;
  if (size_ < storage_.size()) { ++size_; }
  return Status::ok;
}

void PoseBufferCore::clear() {
  next_ = 0;
  size_ = 0;
}

const StampedPose& PoseBufferCore::by_age(std::size_t index) const {
  const std::size_t position = next_ + storage_.size() - size_ + index;
  return storage_[position >= storage_.size() ? position - storage_.size() : position];
}

const StampedPose& PoseBufferCore::newest() const {
  return by_age(size_ - 1);
}

const StampedPose& PoseBufferCore::oldest() const {
  return by_age(0);
}

Result<Pose2d> PoseBufferCore::at(Timestamp stamp) const {
  if (size_ == 0 || stamp > newest().stamp) { return Status::not_ready; }
  if (stamp < oldest().stamp) { return Status::out_of_range; }
  // The first pose at or after `stamp` lies in (low, high].
  std::size_t low = 0;
  std::size_t high = size_ - 1;
  if (by_age(0).stamp == stamp) { return by_age(0).odom_T_base; }
  while (high - low > 1) {
    const std::size_t middle = low + (high - low) / 2;
    (by_age(middle).stamp < stamp ? low : high) = middle;
  }
  const StampedPose& before = by_age(low);
  const StampedPose& after = by_age(high);
  const double share =
      to_seconds_f64(stamp - before.stamp) / to_seconds_f64(after.stamp - before.stamp);
  return interpolate(before.odom_T_base, after.odom_T_base, share);
}

}  // namespace picolo::inline v0
