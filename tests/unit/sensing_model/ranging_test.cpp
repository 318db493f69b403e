// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Ranging against worked numbers.

#include "picolo/sensing/ranging.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(TimeOfFlight, GivenARoundTripThenTheRangeIsHalfTheWayOfLight) {
  EXPECT_NEAR(*time_of_flight_range_m(1e-6, 1.0), 149.896229, 1e-9);
  EXPECT_NEAR(*time_of_flight_range_m(66.712819e-9, 1.0), 10.0, 1e-7);
  EXPECT_EQ(*time_of_flight_range_m(0.0), 0.0);
}

TEST(TimeOfFlight, GivenAMediumThenTheRangeShrinksByItsIndex) {
  EXPECT_NEAR(*time_of_flight_range_m(1e-6, 1.333), 149.896229 / 1.333, 1e-9);  // water
  EXPECT_NEAR(*time_of_flight_range_m(1e-6), 149.896229 / 1.000273, 1e-9);      // air by default
}

TEST(TimeOfFlight, GivenNonsenseThenItIsRefused) {
  EXPECT_EQ(time_of_flight_range_m(-1e-9).status(), Status::invalid_argument);
  EXPECT_EQ(time_of_flight_range_m(kNan).status(), Status::invalid_argument);
  EXPECT_EQ(time_of_flight_range_m(kInfinity).status(), Status::invalid_argument);
  EXPECT_EQ(time_of_flight_range_m(1e-6, 0.9).status(), Status::invalid_argument);
  EXPECT_EQ(time_of_flight_range_m(1e-6, kNan).status(), Status::invalid_argument);
}

TEST(PhaseShift, GivenAFrequencyThenTheAmbiguityIntervalIsHalfTheWavelength) {
  EXPECT_NEAR(*ambiguity_interval_m(10e6, 1.0), 14.9896229, 1e-9);
  EXPECT_NEAR(*ambiguity_interval_m(5e6, 1.0), 29.9792458, 1e-9);
  EXPECT_NEAR(*ambiguity_interval_m(10e6, 1.5), 14.9896229 / 1.5, 1e-9);
  EXPECT_EQ(ambiguity_interval_m(0.0).status(), Status::invalid_argument);
  EXPECT_EQ(ambiguity_interval_m(-1.0).status(), Status::invalid_argument);
  EXPECT_EQ(ambiguity_interval_m(1e6, 0.5).status(), Status::invalid_argument);
}

TEST(PhaseShift, GivenAPhaseThenTimeAndRangeFollow) {
  EXPECT_NEAR(*phase_shift_time_s(std::numbers::pi, 10e6), 50e-9, 1e-20);
  EXPECT_NEAR(*phase_shift_range_m(std::numbers::pi, 10e6, 1.0), 14.9896229 / 2, 1e-9);
  EXPECT_NEAR(*phase_shift_range_m(std::numbers::pi / 2, 10e6, 1.0), 14.9896229 / 4, 1e-9);
  EXPECT_EQ(phase_shift_time_s(kNan, 1e6).status(), Status::invalid_argument);
  EXPECT_EQ(phase_shift_time_s(1.0, 0.0).status(), Status::invalid_argument);
  EXPECT_EQ(phase_shift_range_m(kNan, 1e6).status(), Status::invalid_argument);
  EXPECT_EQ(phase_shift_range_m(kInfinity, 1e6).status(), Status::invalid_argument);
  EXPECT_EQ(phase_shift_range_m(1.0, -1e6).status(), Status::invalid_argument);
}

TEST(PhaseShift, GivenWholeTurnsThenTheRangeIsTheSame) {
  const double once = *phase_shift_range_m(1.0, 10e6);
  for (const int turns : {-3, -1, 1, 7}) {
    EXPECT_NEAR(*phase_shift_range_m(1.0 + 2.0 * std::numbers::pi * turns, 10e6), once, 1e-9);
  }
  EXPECT_GE(*phase_shift_range_m(-1e-18, 10e6), 0.0);
  EXPECT_LT(*phase_shift_range_m(-1e-18, 10e6), *ambiguity_interval_m(10e6));
}

TEST(PhaseShift, GivenTwoFrequenciesThenTheCoarseOneSaysWhichIntervalTheFineOneMeans) {
  Random random{12};
  const double fine = *ambiguity_interval_m(15e6);
  const double coarse = *ambiguity_interval_m(0.5e6);  // 300 m
  for (int i = 0; i < 500; ++i) {
    const double truth = random.uniform(0.0, coarse * 0.99);
    const double fine_phase = truth / fine * 2.0 * std::numbers::pi;
    const double coarse_phase =
        (truth / coarse) * 2.0 * std::numbers::pi + random.uniform(-0.05, 0.05);
    double rough = *phase_shift_range_m(coarse_phase, 0.5e6);
    if (truth < 0.01 * coarse && rough > 0.9 * coarse) { rough = 0.0; }  // noise below zero
    const double wrapped = *phase_shift_range_m(fine_phase, 15e6);
    ASSERT_LT(wrapped, fine);
    EXPECT_NEAR(*resolve_ambiguity_m(wrapped, fine, rough), truth, 1e-6);
  }
}

TEST(PhaseShift, GivenNonsenseThenAmbiguityIsNotResolved) {
  EXPECT_EQ(resolve_ambiguity_m(1.0, 0.0, 3.0).status(), Status::invalid_argument);
  EXPECT_EQ(resolve_ambiguity_m(-1.0, 10.0, 3.0).status(), Status::invalid_argument);
  EXPECT_EQ(resolve_ambiguity_m(1.0, 10.0, -3.0).status(), Status::invalid_argument);
  EXPECT_EQ(resolve_ambiguity_m(1.0, 10.0, kNan).status(), Status::invalid_argument);
  EXPECT_NEAR(*resolve_ambiguity_m(9.0, 10.0, 0.5), 9.0, 1e-12) << "never a negative range";
}

}  // namespace
}  // namespace picolo
