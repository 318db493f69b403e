// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/angle_history.hpp"

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

void AngleHistoryCore::reset() {
  next_ = 0;
  size_ = 0;
}

void AngleHistoryCore::add(double stamp_s, double rate_radps) {
  if (!is_finite(stamp_s) || !is_finite(rate_radps)) { return; }
  double angle = 0.0;
  if (size_ > 0) {
    const StampedAngle& newest = by_age(size_ - 1);
    if (!(stamp_s > newest.stamp_s)) { return; }
    angle = newest.angle_rad + rate_radps * (stamp_s - newest.stamp_s);
  }
  storage_[next_] = {stamp_s, angle};
  next_ = (next_ + 1) % storage_.size();
  size_ = std::min(size_ + 1, storage_.size());
}

Result<double> AngleHistoryCore::at(double stamp_s) const {
  if (size_ < 2 || stamp_s > by_age(size_ - 1).stamp_s) { return Status::not_ready; }
  if (stamp_s < by_age(0).stamp_s) { return Status::out_of_range; }
  std::size_t low = 0;
  std::size_t high = size_ - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (by_age(middle).stamp_s <= stamp_s ? low : high) = middle;
  }
  const StampedAngle& a = by_age(low);
  const StampedAngle& b = by_age(high);
  return a.angle_rad +
         (b.angle_rad - a.angle_rad) * ((stamp_s - a.stamp_s) / (b.stamp_s - a.stamp_s));
}

}  // namespace picolo::inline v0
