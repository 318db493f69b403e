// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The errors stated in math.hpp, measured against long double.

#include "picolo/core/math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

constexpr int kSamples = 200000;
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// A value in higher precision, to measure errors in.
template <typename T>
long double exact(T value) {
  return static_cast<long double>(value);
}

TEST(Math, SinCosStaysWithinItsStatedError) {
  Random random{1};
  long double worst_f32 = 0;
  long double worst_f64 = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto single = static_cast<float>(random.uniform(-1000.0, 1000.0));
    const SinCos<float> s = sin_cos(single);
    worst_f32 = std::max({worst_f32, std::abs(exact(s.sine) - std::sin(exact(single))),
                          std::abs(exact(s.cosine) - std::cos(exact(single)))});
    const double wide = random.uniform(-1e5, 1e5);
    const SinCos<double> d = sin_cos(wide);
    worst_f64 = std::max({worst_f64, std::abs(exact(d.sine) - std::sin(exact(wide))),
                          std::abs(exact(d.cosine) - std::cos(exact(wide)))});
  }
  EXPECT_LE(worst_f32, 1.2e-7L);
  EXPECT_LE(worst_f64, 3e-16L);
}

TEST(Math, ArcTangentStaysWithinItsStatedError) {
  Random random{2};
  long double worst_f32 = 0;
  long double worst_f64 = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double scale = std::pow(10.0, random.uniform(-6, 6));
    const double y = scale * random.uniform(-1, 1);
    const double x = random.uniform(-1, 1);
    worst_f64 =
        std::max(worst_f64, std::abs(exact(arc_tangent2(y, x)) - std::atan2(exact(y), exact(x))));
    const auto ys = static_cast<float>(y);
    const auto xs = static_cast<float>(x);
    worst_f32 = std::max(worst_f32,
                         std::abs(exact(arc_tangent2(ys, xs)) - std::atan2(exact(ys), exact(xs))));
  }
  EXPECT_LE(worst_f32, 3e-7L);
  EXPECT_LE(worst_f64, 5e-16L);
}

TEST(Math, ArcTangentKnowsTheAxesAndSpecialValues) {
  EXPECT_EQ(arc_tangent2(0.0F, 0.0F), 0.0F);
  EXPECT_NEAR(arc_tangent2(1.0, 0.0), 1.5707963267948966, 1e-15);
  EXPECT_NEAR(arc_tangent2(-1.0, 0.0), -1.5707963267948966, 1e-15);
  EXPECT_NEAR(arc_tangent2(0.0, -1.0), 3.141592653589793, 1e-15);
  EXPECT_NEAR(arc_tangent2(kInfinity, 1.0F), 1.5707964F, 1e-6F);
  EXPECT_NEAR(arc_tangent2(kInfinity, kInfinity), 0.7853982F, 1e-6F);
  EXPECT_TRUE(std::isnan(arc_tangent2(kNan, 1.0F)));
}

TEST(Math, ExponentialAndLogarithmStayWithinTheirStatedErrors) {
  Random random{3};
  long double worst_exp_f32 = 0;
  long double worst_exp_f64 = 0;
  long double worst_log_f32 = 0;
  long double worst_log_f64 = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto single = static_cast<float>(random.uniform(-80, 80));
    worst_exp_f32 =
        std::max(worst_exp_f32, std::abs(exact(exponential(single)) / std::exp(exact(single)) - 1));
    const double wide = random.uniform(-700, 700);
    worst_exp_f64 =
        std::max(worst_exp_f64, std::abs(exact(exponential(wide)) / std::exp(exact(wide)) - 1));
    const auto positive = static_cast<float>(std::exp(random.uniform(-85, 85)));
    const long double log_f32 = std::log(exact(positive));
    worst_log_f32 = std::max(worst_log_f32, std::abs(exact(logarithm(positive)) - log_f32) /
                                                std::max(1.0L, std::abs(log_f32)));
    const double positive_wide = std::exp(random.uniform(-700, 700));
    const long double log_f64 = std::log(exact(positive_wide));
    worst_log_f64 = std::max(worst_log_f64, std::abs(exact(logarithm(positive_wide)) - log_f64) /
                                                std::max(1.0L, std::abs(log_f64)));
  }
  EXPECT_LE(worst_exp_f32, 2e-7L);
  EXPECT_LE(worst_exp_f64, 4e-16L);
  EXPECT_LE(worst_log_f32, 2e-7L);
  EXPECT_LE(worst_log_f64, 4e-16L);
}

TEST(Math, ExponentialAndLogarithmAtTheEndsOfTheirRange) {
  EXPECT_EQ(exponential(1000.0F), kInfinity);
  EXPECT_EQ(exponential(-1000.0F), 0.0F);
  EXPECT_TRUE(std::isnan(exponential(kNan)));
  EXPECT_TRUE(std::isnan(logarithm(0.0F)));
  EXPECT_TRUE(std::isnan(logarithm(-1.0)));
  EXPECT_EQ(logarithm(kInfinity), kInfinity);
  EXPECT_NEAR(logarithm(1e-40F), -92.1034F, 1e-3F);  // denormal
}

TEST(Math, NotANumberPassesThroughSinCos) {
  EXPECT_TRUE(std::isnan(sin_cos(kNan).sine));
  EXPECT_TRUE(std::isnan(sin_cos(static_cast<double>(kNan)).cosine));
}

}  // namespace
}  // namespace picolo
