// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/board/counter_time.hpp"

namespace picolo::inline v0::board {

Timestamp CounterTime::at(std::uint32_t count) {
  const std::uint32_t passed = count - last_count_;  // modulo 2^32
  last_count_ = count;
  std::uint32_t us = passed / ticks_per_us_;
  rest_ticks_ += passed % ticks_per_us_;
  if (rest_ticks_ >= ticks_per_us_) {
    rest_ticks_ -= ticks_per_us_;
    ++us;
  }
  last_ += Duration{us};
  return last_;
}

}  // namespace picolo::inline v0::board
