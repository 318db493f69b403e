// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/wheel_walk.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

void WheelWalk::rewind(std::uint64_t limit) {
  rates_.rewind();
  scans_.rewind();
  limit_ = limit;
  taken_ = 0;
  open_ = false;
  WheelRates first;
  if (!rates_.next(first)) { return; }
  last_s_ = first.stamp_s;
  open_ = scans_.next(scan_);
}

bool WheelWalk::next(WheelStretch& stretch, ScanMotion& scan) {
  WheelRates row;
  if (!open_ || !rates_.next(row)) { return false; }
  const bool closes = !(row.stamp_s < scan_.stamp_s);
  const double end_s = closes ? scan_.stamp_s : row.stamp_s;
  stretch = {end_s - last_s_, row.left_radps, row.right_radps, closes};
  scan = scan_;
  last_s_ = end_s;
  if (closes) {
    ++taken_;
    open_ = taken_ != limit_ && scans_.next(scan_);
  }
  return true;
}

}  // namespace picolo::inline v0
