// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/sensing/beam_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr double kInverseRootTwoPi = 0.3989422804014327;

bool is_range(double range_m, double max_range_m) {
  return range_m > 0.0 && range_m < max_range_m;
}

/// Sums of the responsibilities over all pairs.
struct Sums {
  double hit = 0.0;
  double shorter = 0.0;
  double failure = 0.0;
  double random = 0.0;
  double hit_squared = 0.0;      // times (z - z*)^2
  double shorter_range = 0.0;    // times z
  double shorter_missing = 0.0;  // times what the cut at z* hides of the mean, z* / (e^(l z*) - 1)
  double log_likelihood = 0.0;
};

void add(const BeamModel& model, const BeamPair& pair, Sums& sums) {
  const auto z = static_cast<double>(pair.measured_m);
  const auto expected = static_cast<double>(pair.expected_m);
  const auto max_range = static_cast<double>(model.max_range_m);
  if (!is_range(z, max_range)) {
    sums.failure += 1.0;
    sums.log_likelihood += logarithm(static_cast<double>(model.max_weight));
    return;
  }
  const auto sigma = static_cast<double>(model.sigma_m);
  const auto rate = static_cast<double>(model.short_rate_per_m);
  const double off = (z - expected) / sigma;
  const double hit = static_cast<double>(model.hit_weight) * kInverseRootTwoPi / sigma *
                     exponential(-0.5 * off * off);
  const double random = static_cast<double>(model.random_weight) / max_range;
  double shorter = 0.0;
  double missing = 0.0;
  if (z <= expected) {
    const double left = exponential(-rate * expected);
    shorter =
        static_cast<double>(model.short_weight) * rate * exponential(-rate * z) / (1.0 - left);
    missing = expected * left / (1.0 - left);
  }
  const double all = (hit + shorter) + random;
  if (!(all > 0.0)) { return; }
  sums.hit += hit / all;
  sums.shorter += shorter / all;
  sums.random += random / all;
  sums.hit_squared += hit / all * (off * sigma) * (off * sigma);
  sums.shorter_range += shorter / all * z;
  sums.shorter_missing += shorter / all * missing;
  sums.log_likelihood += logarithm(all);
}

BeamModel maximised(const BeamModel& model, const Sums& sums, float min_sigma_m) {
  const double all = (sums.hit + sums.shorter) + (sums.failure + sums.random);
  BeamModel next = model;
  next.hit_weight = static_cast<float>(sums.hit / all);
  next.short_weight = static_cast<float>(sums.shorter / all);
  next.max_weight = static_cast<float>(sums.failure / all);
  next.random_weight = static_cast<float>(sums.random / all);
  if (sums.hit > 0.0) {
    next.sigma_m =
        std::max(min_sigma_m, static_cast<float>(square_root(sums.hit_squared / sums.hit)));
  }
  const double reach = sums.shorter_range + sums.shorter_missing;
  if (sums.shorter > 0.0 && reach > 0.0) {
    next.short_rate_per_m = std::clamp(static_cast<float>(sums.shorter / reach), 1e-3F, 1e3F);
  }
  return next;
}

float change(float before, float after, float scale) {
  const float difference = after > before ? after - before : before - after;
  return difference / scale;
}

float largest_change(const BeamModel& before, const BeamModel& after) {
  return std::max(
      {change(before.hit_weight, after.hit_weight, 1.0F),
       change(before.short_weight, after.short_weight, 1.0F),
       change(before.max_weight, after.max_weight, 1.0F),
       change(before.random_weight, after.random_weight, 1.0F),
       change(before.sigma_m, after.sigma_m, before.sigma_m),
       // A rate without a weight is nobody's.
       after.short_weight > 1e-3F
           ? change(before.short_rate_per_m, after.short_rate_per_m, before.short_rate_per_m)
           : 0.0F});
}

}  // namespace

Status BeamModelFit::begin(std::span<const BeamPair> pairs, const BeamModel& start) {
  done_ = true;
  report_ = {};
  report_.model = start;
  if (!config_.valid() || !start.valid() || !(start.hit_weight > 0.0F) ||
      !(start.short_weight > 0.0F) || !(start.max_weight > 0.0F) || !(start.random_weight > 0.0F)) {
    return Status::invalid_argument;
  }
  for (const BeamPair& pair : pairs) {
    if (is_range(static_cast<double>(pair.expected_m), static_cast<double>(start.max_range_m))) {
      ++report_.pairs;
    }
  }
  if (report_.pairs < config_.min_pairs) { return Status::degenerate; }
  pairs_ = pairs;
  done_ = false;
  return Status::ok;
}

bool BeamModelFit::step() {
  if (done_) { return true; }
  Sums sums;
  const auto max_range = static_cast<double>(report_.model.max_range_m);
  for (const BeamPair& pair : pairs_) {
    if (!is_range(static_cast<double>(pair.expected_m), max_range)) { continue; }
    add(report_.model, pair, sums);
  }
  const BeamModel next = maximised(report_.model, sums, config_.min_sigma_m);
  report_.mean_log_likelihood = sums.log_likelihood / static_cast<double>(report_.pairs);
  report_.converged = largest_change(report_.model, next) < config_.converged;
  report_.model = next;
  ++report_.iterations;
  done_ = report_.converged || report_.iterations >= config_.max_iterations;
  return done_;
}

}  // namespace picolo::inline v0
