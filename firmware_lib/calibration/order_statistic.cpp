// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/order_statistic.hpp"

#include <bit>
#include <limits>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

void OrderStatistic::select(std::uint64_t index) {
  prefix_ = 0;
  index_ = index;
  bits_left_ = 64;
  beyond_ = false;
  counts_.fill(0);
}

void OrderStatistic::offer(double value) {
  const std::uint64_t bits = value > 0.0 ? std::bit_cast<std::uint64_t>(value) : 0U;
  if (bits_left_ < 64 && (bits >> bits_left_) != prefix_) { return; }
  ++counts_[(bits >> (bits_left_ - 4)) & 0xFU];
}

void OrderStatistic::end_pass() {
  bits_left_ -= 4;
  for (std::uint32_t digit = 0; digit < 16; ++digit) {
    const std::uint64_t count = counts_[digit];
    if (index_ < count) {
      prefix_ = (prefix_ << 4) | digit;
      counts_.fill(0);
      return;
    }
    index_ -= count;
  }
  beyond_ = true;
  bits_left_ = 0;
}

double OrderStatistic::value() const {
  return beyond_ ? std::numeric_limits<double>::infinity() : std::bit_cast<double>(prefix_);
}

}  // namespace picolo::inline v0
