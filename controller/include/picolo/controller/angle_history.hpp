// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The integral of a gyro over the last second or so.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "picolo/core/result.hpp"

namespace picolo::inline v0 {

struct StampedAngle {
  double stamp_s = 0.0;
  double angle_rad = 0.0;
};

/// Over storage it does not own. Context: one at a time.
class AngleHistoryCore {
 public:
  explicit AngleHistoryCore(std::span<StampedAngle> storage) : storage_(storage) {}
  void reset();
  /// The rate covers the time since the sample before, which ends at the stamp. Not later than the
  /// newest, or not finite: left out.
  void add(double stamp_s, double rate_radps);
  /// `not_ready`: not reached yet; `out_of_range`: forgotten. Cost: O(log n).
  [[nodiscard]] Result<double> at(double stamp_s) const;
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  [[nodiscard]] const StampedAngle& by_age(std::size_t index) const {
    return storage_[(next_ + storage_.size() - size_ + index) % storage_.size()];
  }

  std::span<StampedAngle> storage_;
  std::size_t next_ = 0;
  std::size_t size_ = 0;
};

/// Storage: 16 bytes a sample.
template <std::size_t Capacity>
class AngleHistory {
  static_assert(Capacity >= 2);

 public:
  AngleHistory() : core_(storage_) {}
  AngleHistory(const AngleHistory&) = delete;
  AngleHistory& operator=(const AngleHistory&) = delete;
  ~AngleHistory() = default;
  [[nodiscard]] AngleHistoryCore& core() { return core_; }
  [[nodiscard]] const AngleHistoryCore& core() const { return core_; }

 private:
  std::array<StampedAngle, Capacity> storage_{};
  AngleHistoryCore core_;
};

}  // namespace picolo::inline v0
