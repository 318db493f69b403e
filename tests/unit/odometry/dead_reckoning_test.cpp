// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace picolo {
namespace {

Timestamp at_ms(int ms) {
  return Timestamp{Duration{ms * 1000}};
}

ImuSample gyro(int ms, double rate_radps) {
  ImuSample sample{.stamp = at_ms(ms)};
  sample.rate_radps = {0.0F, 0.0F, static_cast<float>(rate_radps)};
  return sample;
}

WheelIncrement wheels(int from_ms, int to_ms, double path_m, double turn_rad) {
  return {at_ms(from_ms), at_ms(to_ms), exp_se2(Tangent2<double>{path_m, 0.0, turn_rad}),
          path_m == 0.0 && turn_rad == 0.0};
}

TEST(DeadReckoning, WithoutGyroTheWheelsTurnAlone) {
  DeadReckoning reckoning;
  for (int i = 0; i < 100; ++i) { reckoning.add(wheels(10 * i, 10 * i + 10, 0.01, 0.01)); }
  EXPECT_NEAR(reckoning.pose().odom_T_base.theta_rad, 1.0, 1e-9);
  EXPECT_NEAR(reckoning.pose().odom_T_base.x_m, std::sin(1.0), 1e-9);
  EXPECT_NEAR(reckoning.base_twist().x_mps, 1.0F, 1e-5F);
  EXPECT_NEAR(reckoning.base_twist().omega_radps, 1.0F, 1e-5F);
  EXPECT_EQ(reckoning.counters().with_gyro, 0U);
}

TEST(DeadReckoning, StampsInABunchAreNoSpeed) {
  DeadReckoning reckoning;
  reckoning.add(wheels(0, 10, 0.01, 0.0));
  WheelIncrement bunched = wheels(10, 10, 0.0003, 0.0);
  bunched.to += 1us;
  reckoning.add(bunched);
  EXPECT_NEAR(reckoning.pose().odom_T_base.x_m, 0.0103, 1e-9) << "the way counts";
  EXPECT_NEAR(reckoning.base_twist().x_mps, 1.0F, 1e-5F) << "300 m/s";
}

TEST(DeadReckoning, TheGyroCorrectsTheTurnOfSlippingWheels) {
  DeadReckoning reckoning;
  for (int ms = 0; ms <= 1000; ms += 5) {
    reckoning.add(gyro(ms, 0.8));
    if (ms > 0 && ms % 10 == 0) {
      reckoning.add(wheels(ms - 10, ms, 0.01, 0.02));
    }  // the wheels claim 2 rad/s
  }
  // The first increment has no gyro angle at its beginning.
  EXPECT_EQ(reckoning.counters().with_gyro, 99U);
  EXPECT_NEAR(reckoning.pose().odom_T_base.theta_rad, 0.02 + 0.99 * 0.8, 1e-6);
}

TEST(DeadReckoning, ALateGyroSampleCorrectsTheNextIncrement) {
  DeadReckoning on_time;
  DeadReckoning late;
  const auto rate = [](int ms) { return std::sin(0.01 * ms); };
  for (int ms = 0; ms <= 1000; ms += 10) {
    on_time.add(gyro(ms, rate(ms)));
    if (ms > 0) { on_time.add(wheels(ms - 10, ms, 0.0, 0.001)); }
    if (ms > 0) { late.add(wheels(ms - 10, ms, 0.0, 0.001)); }
    late.add(gyro(ms, rate(ms)));
  }
  // Both took the same first two increments from the wheels or the gyro; from then on no drift
  // builds up between them.
  EXPECT_NEAR(on_time.pose().odom_T_base.theta_rad, late.pose().odom_T_base.theta_rad, 0.01);
  EXPECT_NEAR(on_time.pose().odom_T_base.theta_rad, 0.18, 0.02) << "integral of sin(10 t) over 1 s";
}

TEST(DeadReckoning, ASilentGyroIsReplacedByTheWheels) {
  DeadReckoning reckoning;
  for (int ms = 0; ms <= 500; ms += 10) {
    if (ms <= 200) { reckoning.add(gyro(ms, 0.0)); }
    if (ms > 0) { reckoning.add(wheels(ms - 10, ms, 0.0, 0.01)); }
  }
  // Until 200 ms the gyro says "no turn", for 25 ms its last rate holds, then the wheels count.
  EXPECT_NEAR(reckoning.pose().odom_T_base.theta_rad, 0.01 + 28 * 0.01, 1e-9);
}

TEST(DeadReckoning, BiasIsLearntAtStandstillOnly) {
  DeadReckoning reckoning;
  constexpr double kBias = 0.02;
  for (int ms = 0; ms <= 3000; ms += 10) {
    reckoning.add(gyro(ms, kBias));
    if (ms > 0) { reckoning.add(wheels(ms - 10, ms, 0.0, 0.0)); }
  }
  EXPECT_TRUE(reckoning.gyro_bias_known());
  EXPECT_NEAR(reckoning.gyro_bias_radps(), kBias, 1e-6);
  const double before = reckoning.pose().odom_T_base.theta_rad;
  for (int ms = 3010; ms <= 6000; ms += 10) {
    reckoning.add(gyro(ms, kBias + 0.5));
    reckoning.add(wheels(ms - 10, ms, 0.01, 0.005));
  }
  EXPECT_NEAR(reckoning.gyro_bias_radps(), kBias, 1e-6) << "driving teaches no bias";
  EXPECT_NEAR(reckoning.pose().odom_T_base.theta_rad - before, 0.5 * 3.0, 0.01);
}

TEST(DeadReckoning, GivenACoarseEncoderThenAStartTeachesNoBias) {
  DeadReckoning reckoning;
  constexpr double kBias = 0.004;
  // The vehicle turns from 1100 ms on, the wheels count 150 ms later.
  for (int ms = 0; ms <= 1250; ms += 10) {
    reckoning.add(gyro(ms, ms < 1100 ? kBias : kBias + 0.001 * (ms - 1100)));
    if (ms > 0) { reckoning.add(wheels(ms - 10, ms, 0.0, ms < 1250 ? 0.0 : 0.004)); }
  }
  EXPECT_NEAR(reckoning.gyro_bias_radps(), kBias, 1e-6);
}

TEST(DeadReckoning, MatchesDrawTheBiasTowardsTheirHeadings) {
  const DeadReckoningConfig config{.bias_follows = 5s};
  DeadReckoning reckoning{config};
  constexpr double kBias = 0.02;
  double heading_rad = 0.0;
  for (int ms = 0; ms <= 10'000; ms += 10) {
    reckoning.add(gyro(ms, kBias));
    if (ms > 0) { reckoning.add(wheels(ms - 10, ms, 0.01, 0.0)); }
    if (ms % 100 != 0) { continue; }
    const double now_rad = reckoning.pose().odom_T_base.theta_rad;
    reckoning.correct_bias(static_cast<float>(heading_rad - now_rad));  // it drives straight on
    heading_rad = now_rad;
  }
  EXPECT_NEAR(reckoning.gyro_bias_radps(), kBias * (1.0 - std::exp(-2.0)), 5e-4);
  reckoning.correct_bias(-10.0F);
  EXPECT_EQ(reckoning.gyro_bias_radps(), config.max_bias_radps);
}

TEST(DeadReckoning, APushedVehicleTeachesNoBias) {
  DeadReckoning reckoning;
  for (int ms = 0; ms <= 3000; ms += 10) {
    reckoning.add(gyro(ms, 0.4));
    if (ms > 0) { reckoning.add(wheels(ms - 10, ms, 0.0, 0.0)); }
  }
  EXPECT_EQ(reckoning.gyro_bias_radps(), 0.0F);
}

TEST(DeadReckoning, SaturatedAndStaleSamplesAreRejected) {
  DeadReckoning reckoning;
  reckoning.add(gyro(10, 1.0));
  reckoning.add(gyro(10, 1.0));
  reckoning.add(gyro(5, 1.0));
  ImuSample saturated = gyro(20, 34.9);
  saturated.saturated = true;
  reckoning.add(saturated);
  EXPECT_EQ(reckoning.counters().gyro_rejected, 3U);
  EXPECT_EQ(reckoning.last_gyro_stamp(), at_ms(10));
}

TEST(DeadReckoning, AnUpsideDownGyroTurnsTheOtherWay) {
  DeadReckoning reckoning{{.gyro_sign = -1.0F}};
  for (int ms = 0; ms <= 1000; ms += 10) {
    reckoning.add(gyro(ms, 0.5));
    if (ms > 0) { reckoning.add(wheels(ms - 10, ms, 0.0, -0.005)); }
  }
  EXPECT_NEAR(reckoning.pose().odom_T_base.theta_rad, -0.5, 1e-3);
}

}  // namespace
}  // namespace picolo
