// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sensing/beam_model.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr float kInverseRootTwoPi = 0.3989422804F;
constexpr float kLeastLikelihood = 1e-9F;

bool is_failure(const BeamModel& model, float measured_m) {
  return !(measured_m > 0.0F && measured_m < model.max_range_m);
}

}  // namespace

float beam_likelihood(const BeamModel& model, const BeamPair& pair) {
  if (is_failure(model, pair.measured_m)) { return model.max_weight; }
  const float off = (pair.measured_m - pair.expected_m) / model.sigma_m;
  float likelihood =
      model.hit_weight * kInverseRootTwoPi / model.sigma_m * exponential(-0.5F * off * off) +
      model.random_weight / model.max_range_m;
  if (pair.measured_m <= pair.expected_m) {
    const float rate = model.short_rate_per_m;
    const float whole = 1.0F - exponential(-rate * pair.expected_m);
    likelihood += model.short_weight * rate * exponential(-rate * pair.measured_m) / whole;
  }
  return likelihood;
}

float scan_log_likelihood(const BeamModel& model, std::span<const BeamPair> pairs) {
  float sum = 0.0F;
  for (const BeamPair& pair : pairs) {
    if (is_failure(model, pair.expected_m)) { continue; }
    const float likelihood = beam_likelihood(model, pair);
    sum += logarithm(likelihood > kLeastLikelihood ? likelihood : kLeastLikelihood);
  }
  return sum;
}

}  // namespace picolo::inline v0
