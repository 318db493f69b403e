// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Integer scores of the searches: equal on every platform and independent of the order of
/// summation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/map/likelihood_field.hpp"
#include "picolo/matching/match_report.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kMaxSearchPoints = 128;
inline constexpr int kFullScore = 255;  ///< of one point on an obstacle

/// What a point at distance d of the nearest obstacle is worth: exp(-d^2 / (2 sigma^2)); nothing
/// beyond the field's reach.
struct SearchScore {
  float sigma_m = 0.2F;
  float prior_weight = 0.009F;  ///< 0.03 * 0.3: penalty of a unit of squared Mahalanobis distance
  [[nodiscard]] constexpr bool valid() const { return sigma_m > 0.0F && prior_weight >= 0.0F; }
};

/// Field byte -> score.
using ScoreTable = std::array<std::uint8_t, 256>;
[[nodiscard]] ScoreTable make_score_table(const SearchScore& score, float reach_m);

/// The penalty of a prior in integer score units, along one axis at a time: only the diagonal of
/// the information counts, so that the least penalty over a box of poses is known exactly.
struct PriorPenalty {
  PosePrior prior{};
  float units = 0.0F;  ///< score units of one unit of squared Mahalanobis distance
  [[nodiscard]] std::int32_t x(float x_m) const;
  [[nodiscard]] std::int32_t y(float y_m) const;
  [[nodiscard]] std::int32_t theta(float theta_rad) const;
};
[[nodiscard]] PriorPenalty make_penalty(const SearchScore& score, const PosePrior& prior,
                                        std::size_t points);

/// The k-th of `chosen` points spread evenly over `all`. Precondition: k < chosen <= all.
[[nodiscard]] constexpr std::size_t spread_index(std::size_t k, std::size_t chosen,
                                                 std::size_t all) {
  return k * all / chosen;
}

}  // namespace picolo::inline v0
