// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/turn_cutter.hpp"

namespace picolo::inline v0 {

bool TurnCutter::passes_zero(std::uint32_t angle) {
  const auto full = static_cast<std::int32_t>(full_turn_);
  const std::int32_t half = full / 2;
  const std::uint32_t before = last_angle_;
  last_angle_ = angle;
  if (!has_last_) {
    has_last_ = true;
    since_start_ = half;  // the first passage counts, however soon it comes
    return false;
  }
  const auto forward = static_cast<std::int32_t>((angle + full_turn_ - before) % full_turn_);
  const bool went_back = forward > half;
  since_start_ += went_back ? forward - full : forward;
  if (went_back || angle >= before || since_start_ < half) { return false; }
  since_start_ = static_cast<std::int32_t>(angle);
  return true;
}

}  // namespace picolo::inline v0
