// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Cuts a stream of wheel rates into the intervals of scan motions: each row's rates cover the
/// interval that ends at it; the row that reaches or passes a scan stamp closes the scan's interval
/// at the stamp and is consumed.
#pragma once

#include <cstdint>

#include "picolo/calibration/samples.hpp"

namespace picolo::inline v0 {

/// A stretch of constant rates inside of one scan interval.
struct WheelStretch {
  double duration_s = 0.0;
  double left_radps = 0.0;
  double right_radps = 0.0;
  bool closes = false;  ///< the last stretch before the scan stamp
};

/// Two sources read side by side. Cost: O(1) a call. Context: one reader.
class WheelWalk {
 public:
  WheelWalk(SampleSource<WheelRates>& rates, SampleSource<ScanMotion>& scans)
      : rates_(rates), scans_(scans) {}

  /// Starts over; at most `limit` scans (0: all).
  void rewind(std::uint64_t limit);
  /// The next stretch and the scan it belongs to; false when rates or scans have ended. The first
  /// row only starts the clock.
  [[nodiscard]] bool next(WheelStretch& stretch, ScanMotion& scan);

 private:
  SampleSource<WheelRates>& rates_;
  SampleSource<ScanMotion>& scans_;
  ScanMotion scan_{};
  double last_s_ = 0.0;
  std::uint64_t limit_ = 0;
  std::uint64_t taken_ = 0;
  bool open_ = false;
};

}  // namespace picolo::inline v0
