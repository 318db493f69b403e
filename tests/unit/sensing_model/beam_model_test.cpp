// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The mixture as a probability, and its parameters recovered from simulated ranges.

#include "picolo/sensing/beam_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

/// Draws from the model itself.
std::vector<BeamPair> simulate(const BeamModel& model, int count, std::uint64_t seed) {
  Random random{seed};
  std::vector<BeamPair> pairs;
  const auto max_range = static_cast<double>(model.max_range_m);
  const auto rate = static_cast<double>(model.short_rate_per_m);
  for (int i = 0; i < count; ++i) {
    const double expected = random.uniform(1.0, 0.7 * max_range);
    const double cause = random.uniform_f64();
    const double draw = random.uniform_f64();
    double z = 0.0;
    if (cause < static_cast<double>(model.hit_weight)) {
      z = expected + static_cast<double>(model.sigma_m) * random.gaussian();
    } else if (cause < static_cast<double>(model.hit_weight + model.short_weight)) {
      z = -std::log(1.0 - draw * (1.0 - std::exp(-rate * expected))) / rate;
    } else if (cause <
               static_cast<double>(model.hit_weight + model.short_weight + model.max_weight)) {
      z = i % 2 == 0 ? max_range : 0.0;
    } else {
      z = draw * max_range;
    }
    pairs.push_back({static_cast<float>(z), static_cast<float>(expected)});
  }
  return pairs;
}

constexpr BeamModel kTrue{.hit_weight = 0.7F,
                          .short_weight = 0.15F,
                          .max_weight = 0.05F,
                          .random_weight = 0.1F,
                          .sigma_m = 0.08F,
                          .short_rate_per_m = 0.4F,
                          .max_range_m = 20.0F};

TEST(BeamModel, GivenAnyExpectationThenTheProbabilitiesSumToOne) {
  for (const float expected : {0.7F, 3.0F, 11.0F, 19.0F}) {
    double sum = static_cast<double>(beam_likelihood(kTrue, {20.0F, expected}));  // the mass
    constexpr double kStep = 1e-3;
    for (double z = 0.5 * kStep; z < 20.0; z += kStep) {
      sum += kStep * static_cast<double>(beam_likelihood(kTrue, {static_cast<float>(z), expected}));
    }
    EXPECT_NEAR(sum, 1.0, 2e-3) << expected;
  }
}

TEST(BeamModel, GivenEachCauseAloneThenItHasItsTextbookShape) {
  const BeamModel hit{1, 0, 0, 0, 0.1F, 0.5F, 20.0F};
  EXPECT_NEAR(beam_likelihood(hit, {5.0F, 5.0F}), 3.98942F, 1e-4F);
  EXPECT_NEAR(beam_likelihood(hit, {5.1F, 5.0F}), 3.98942F * std::exp(-0.5F), 1e-4F);
  const BeamModel random{0, 0, 0, 1, 0.1F, 0.5F, 20.0F};
  EXPECT_NEAR(beam_likelihood(random, {17.0F, 5.0F}), 0.05F, 1e-7F);
  const BeamModel shorter{0, 1, 0, 0, 0.1F, 0.5F, 20.0F};
  EXPECT_NEAR(beam_likelihood(shorter, {2.0F, 5.0F}),
              0.5F * std::exp(-1.0F) / (1.0F - std::exp(-2.5F)), 1e-6F);
  EXPECT_EQ(beam_likelihood(shorter, {5.1F, 5.0F}), 0.0F);
  const BeamModel failure{0, 0, 1, 0, 0.1F, 0.5F, 20.0F};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const float z : {0.0F, -1.0F, 20.0F, 81.83F, nan, INFINITY}) {
    EXPECT_EQ(beam_likelihood(failure, {z, 5.0F}), 1.0F) << z;
  }
  EXPECT_EQ(beam_likelihood(failure, {7.0F, 5.0F}), 0.0F);
}

TEST(BeamModel, GivenAScanThenItsLogLikelihoodAddsUpAndPrefersTheRightExpectation) {
  const auto pairs = simulate(kTrue, 180, 5);
  double sum = 0.0;
  for (const BeamPair& pair : pairs) {
    sum += std::log(static_cast<double>(beam_likelihood(kTrue, pair)));
  }
  EXPECT_NEAR(static_cast<double>(scan_log_likelihood(kTrue, pairs)), sum, 1e-3 * std::abs(sum));
  auto shifted = pairs;
  for (BeamPair& pair : shifted) { pair.expected_m += 0.3F; }
  EXPECT_GT(scan_log_likelihood(kTrue, pairs), scan_log_likelihood(kTrue, shifted) + 100.0F);
}

TEST(BeamModel, GivenImpossibleOrUnexpectedBeamsThenTheLikelihoodStaysFinite) {
  const BeamModel hit{1, 0, 0, 0, 0.01F, 0.5F, 20.0F};
  const std::vector<BeamPair> impossible{{1.0F, 15.0F}};
  EXPECT_NEAR(scan_log_likelihood(hit, impossible), std::log(1e-9F), 1e-3F);
  const std::vector<BeamPair> no_expectation{{1.0F, 0.0F}, {1.0F, 25.0F}};
  EXPECT_EQ(scan_log_likelihood(hit, no_expectation), 0.0F);
}

TEST(BeamModelFit, GivenSimulatedRangesThenWeightsAndSigmaAreRecoveredWithinTwoPercent) {
  const auto pairs = simulate(kTrue, 200000, 77);
  BeamModelFit fit;
  BeamModel start{.max_range_m = 20.0F};
  start.sigma_m = 0.3F;
  start.short_rate_per_m = 1.5F;
  ASSERT_EQ(fit.begin(pairs, start), Status::ok);
  double before = -1e9;
  while (!fit.step()) {
    ASSERT_GE(fit.report().mean_log_likelihood, before - 1e-7) << "EM never loses likelihood";
    before = fit.report().mean_log_likelihood;
  }
  const BeamFitReport& report = fit.report();
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.pairs, pairs.size());
  EXPECT_NEAR(report.model.hit_weight, kTrue.hit_weight, 0.02F * kTrue.hit_weight);
  EXPECT_NEAR(report.model.short_weight, kTrue.short_weight, 0.02F * kTrue.short_weight);
  EXPECT_NEAR(report.model.max_weight, kTrue.max_weight, 0.02F * kTrue.max_weight);
  EXPECT_NEAR(report.model.random_weight, kTrue.random_weight, 0.02F * kTrue.random_weight);
  EXPECT_NEAR(report.model.sigma_m, kTrue.sigma_m, 0.02F * kTrue.sigma_m);
  EXPECT_NEAR(report.model.short_rate_per_m, kTrue.short_rate_per_m,
              0.04F * kTrue.short_rate_per_m);
  EXPECT_NEAR(report.model.hit_weight + report.model.short_weight + report.model.max_weight +
                  report.model.random_weight,
              1.0F, 1e-5F);
}

TEST(BeamModelFit, GivenOtherTruthsThenTheyAreRecoveredToo) {
  for (const BeamModel& truth : {BeamModel{0.9F, 0.05F, 0.03F, 0.02F, 0.02F, 0.8F, 30.0F},
                                 BeamModel{0.4F, 0.3F, 0.2F, 0.1F, 0.2F, 0.3F, 10.0F}}) {
    const auto pairs = simulate(truth, 100000, 3);
    BeamModelFit fit{{.max_iterations = 1000}};
    ASSERT_EQ(fit.begin(pairs, {.max_range_m = truth.max_range_m}), Status::ok);
    while (!fit.step()) {}
    EXPECT_NEAR(fit.report().model.hit_weight, truth.hit_weight, 0.02F * truth.hit_weight);
    EXPECT_NEAR(fit.report().model.sigma_m, truth.sigma_m, 0.02F * truth.sigma_m);
    EXPECT_NEAR(fit.report().model.max_weight, truth.max_weight, 0.003F);
    EXPECT_NEAR(fit.report().model.short_weight, truth.short_weight, 0.02F);
    EXPECT_NEAR(fit.report().model.random_weight, truth.random_weight, 0.02F);
  }
}

TEST(BeamModelFit, GivenIdenticalRangesThenSigmaStaysAtItsFloor) {
  const std::vector<BeamPair> pairs(500, BeamPair{4.0F, 4.0F});
  BeamModelFit fit;
  ASSERT_EQ(fit.begin(pairs), Status::ok);
  while (!fit.step()) {}
  EXPECT_FLOAT_EQ(fit.report().model.sigma_m, 1e-3F);
  EXPECT_NEAR(fit.report().model.hit_weight, 1.0F, 1e-3F);
}

TEST(BeamModelFit, GivenTooLittleOrABadGuessThenItIsRefused) {
  const auto pairs = simulate(kTrue, 199, 1);
  BeamModelFit fit;
  EXPECT_EQ(fit.begin(pairs, kTrue), Status::degenerate);
  EXPECT_TRUE(fit.step());
  BeamModel zero = kTrue;
  zero.short_weight = 0.0F;
  EXPECT_EQ(fit.begin(pairs, zero), Status::invalid_argument) << "EM never leaves a zero weight";
  zero = kTrue;
  zero.sigma_m = 0.0F;
  EXPECT_EQ(fit.begin(pairs, zero), Status::invalid_argument);
  const std::vector<BeamPair> unexpected(500, BeamPair{4.0F, 0.0F});
  EXPECT_EQ(fit.begin(unexpected, kTrue), Status::degenerate);
}

}  // namespace
}  // namespace picolo
