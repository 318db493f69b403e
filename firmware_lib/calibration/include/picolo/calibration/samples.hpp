// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What calibration procedures consume, and where it is read from again and again.
#pragma once

#include <cstddef>
#include <span>

#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0 {

/// Between two scans: mean wheel rates, and the motion of the lidar in its own frame (last_T_now).
struct MotionSample {
  double duration_s = 0.0;
  double left_radps = 0.0;
  double right_radps = 0.0;
  Pose2d lidar_motion{};
};

/// Rates of both wheels over the interval that ends at the stamp.
struct WheelRates {
  double stamp_s = 0.0;
  double left_radps = 0.0;
  double right_radps = 0.0;
};

/// Motion of the base between the scan before and the scan at the stamp (last_T_now).
struct ScanMotion {
  double stamp_s = 0.0;
  Pose2d motion{};
};

/// The same displacement seen twice: by odometry in base, by scan matching in its own frame.
struct MotionPair {
  Pose2d odometry{};
  Pose2d scan{};
};

/// A sequence that can be read several times: a file on a host, a fixed buffer on a target. A
/// procedure keeps no sample, so its memory does not depend on how many there are. Context: one
/// reader.
template <typename Sample>
class SampleSource {
 public:
  virtual void rewind() = 0;
  /// False at the end; sample is unchanged then.
  [[nodiscard]] virtual bool next(Sample& sample) = 0;

 protected:
  SampleSource() = default;
  SampleSource(const SampleSource&) = default;
  SampleSource& operator=(const SampleSource&) = default;
  ~SampleSource() = default;
};

/// A source over memory of somebody else, e.g. `FixedVector::view()`, whose `push_back` reports
/// when its limit is reached.
template <typename Sample>
class SpanSource final : public SampleSource<Sample> {
 public:
  explicit SpanSource(std::span<const Sample> samples) : samples_(samples) {}
  void rewind() override { next_ = 0; }
  [[nodiscard]] bool next(Sample& sample) override {
    if (next_ == samples_.size()) { return false; }
    sample = samples_[next_];
    ++next_;
    return true;
  }

 private:
  std::span<const Sample> samples_;
  std::size_t next_ = 0;
};

}  // namespace picolo::inline v0
