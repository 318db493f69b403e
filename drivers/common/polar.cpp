// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/polar.hpp"

#include <numbers>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

float clockwise_bearing_rad(std::int32_t angle, std::int32_t full_turn) {
  std::int32_t clockwise = angle % full_turn;
  if (clockwise > full_turn / 2) { clockwise -= full_turn; }
  if (clockwise < -(full_turn / 2)) { clockwise += full_turn; }
  return static_cast<float>(-clockwise) * (2.0F * std::numbers::pi_v<float>) /
         static_cast<float>(full_turn);
}

}  // namespace picolo::inline v0
