// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/score_table.hpp"

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int32_t kMaxPenalty = 1 << 20;  // far above every score, far below overflow

std::int32_t penalty_of(float units, float information, float error) {
  return round_to_i32(units * information * error * error, 0, kMaxPenalty);
}

}  // namespace

ScoreTable make_score_table(const SearchScore& score, float reach_m) {
  ScoreTable table{};
  const float per_byte_m = reach_m / 255.0F;
  const float factor = -0.5F / (score.sigma_m * score.sigma_m);
  for (std::size_t byte = 0; byte < 255; ++byte) {
    const float distance_m = per_byte_m * static_cast<float>(byte);
    const float likelihood = exponential(factor * distance_m * distance_m);
    table[byte] = static_cast<std::uint8_t>(
        round_to_i32(static_cast<float>(kFullScore) * likelihood, 0, kFullScore));
  }
  return table;
}

PriorPenalty make_penalty(const SearchScore& score, const PosePrior& prior, std::size_t points) {
  return {prior, score.prior_weight * static_cast<float>(kFullScore) * static_cast<float>(points)};
}

std::int32_t PriorPenalty::x(float x_m) const {
  return penalty_of(units, prior.information(0, 0), x_m - prior.pose.x_m);
}

std::int32_t PriorPenalty::y(float y_m) const {
  return penalty_of(units, prior.information(1, 1), y_m - prior.pose.y_m);
}

std::int32_t PriorPenalty::theta(float theta_rad) const {
  return penalty_of(units, prior.information(2, 2), wrap_angle(theta_rad - prior.pose.theta_rad));
}

}  // namespace picolo::inline v0
