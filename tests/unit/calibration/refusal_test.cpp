// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What a drive must show: each insufficient class is refused with its reason and parameter, no
// sufficient drive is.

#include <gtest/gtest.h>

#include "picolo/calibration/joint_batch.hpp"
#include "picolo/calibration/motion_check.hpp"
#include "simulated_drive.hpp"

namespace picolo {
namespace {

using test::drive;
using test::Leg;
using test::Noise;
using test::truth;

const Noise kTypical{0.002, 0.002, 0.002};

Refusal judged(const std::vector<MotionSample>& samples) {
  MotionCheck check;
  for (const MotionSample& sample : samples) { check.add(sample); }
  return check.judge({});
}

Refusal joint_refusal(const std::vector<MotionSample>& samples) {
  SpanSource<MotionSample> source{samples};
  JointReport report;
  const Status status = calibrate_joint(source, {}, report);
  EXPECT_EQ(is_ok(status), !report.refusal);
  return report.refusal;
}

struct Insufficient {
  const char* name;
  std::vector<Leg> legs;
  RefusalReason reason;
  Parameter parameter;
};

std::vector<Insufficient> classes() {
  return {{"standing", {{0, 0, 60}}, RefusalReason::standing_still, Parameter::wheel_radius_left},
          {"straight", {{5, 5, 60}}, RefusalReason::straight_only, Parameter::track_width},
          {"straight to and fro",
           {{5, 5, 30}, {-5, -5, 30}},
           RefusalReason::straight_only,
           Parameter::track_width},
          {"rotation",
           {{-2, 2, 30}, {2, -2, 30}},
           RefusalReason::pure_rotation,
           Parameter::wheel_radius_left},
          {"arc", {{4, 6, 60}}, RefusalReason::constant_arc, Parameter::track_width},
          {"arc at two speeds",
           {{4, 6, 30}, {2, 3, 30}},
           RefusalReason::constant_arc,
           Parameter::track_width},
          {"left only",
           {{5, 5, 20}, {4, 6, 20}, {3, 6, 20}},
           RefusalReason::one_turn_direction,
           Parameter::track_width},
          {"too short",
           {{4, 6, 0.6}, {6, 4, 0.6}},
           RefusalReason::too_little_data,
           Parameter::wheel_radius_left}};
}

TEST(Refusal, EveryInsufficientClassIsNamed) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    for (const Insufficient& c : classes()) {
      const auto samples = drive(truth(), c.legs, kTypical, seed);
      EXPECT_EQ(judged(samples).reason, c.reason)
          << c.name << ": " << to_string(judged(samples).reason);
      EXPECT_EQ(judged(samples).parameter, c.parameter) << c.name;
      EXPECT_EQ(joint_refusal(samples).reason, c.reason) << c.name;
    }
  }
}

TEST(Refusal, EncodersThatAreConnectedWrongAreNamed) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    const auto good = drive(truth(), test::sufficient_legs(seed), kTypical, seed);
    auto swapped = good;
    auto left_reversed = good;
    auto right_reversed = good;
    auto left_dead = good;
    auto right_dead = good;
    for (std::size_t k = 0; k < good.size(); ++k) {
      std::swap(swapped[k].left_radps, swapped[k].right_radps);
      left_reversed[k].left_radps *= -1;
      right_reversed[k].right_radps *= -1;
      left_dead[k].left_radps = 0;
      right_dead[k].right_radps = 0;
    }
    EXPECT_EQ(joint_refusal(swapped),
              (Refusal{RefusalReason::encoder_swapped, Parameter::wheel_radius_left}));
    EXPECT_EQ(joint_refusal(left_reversed),
              (Refusal{RefusalReason::encoder_reversed, Parameter::wheel_radius_left}));
    EXPECT_EQ(joint_refusal(right_reversed),
              (Refusal{RefusalReason::encoder_reversed, Parameter::wheel_radius_right}));
    EXPECT_EQ(joint_refusal(left_dead),
              (Refusal{RefusalReason::encoder_disconnected, Parameter::wheel_radius_left}));
    EXPECT_EQ(joint_refusal(right_dead),
              (Refusal{RefusalReason::encoder_disconnected, Parameter::wheel_radius_right}));
  }
}

TEST(Refusal, NoSufficientDriveIsRefused) {
  int refused = 0;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    const auto samples = drive(truth(), test::sufficient_legs(seed), kTypical, seed);
    if (judged(samples)) { ++refused; }
    if (seed % 10 == 0 && joint_refusal(samples)) { ++refused; }
  }
  EXPECT_EQ(refused, 0);
}

TEST(SwingMeter, NoiseBelowTheThresholdIsNoSwing) {
  SwingMeter meter{0.15};
  Random random{3};
  double heading = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double next = 0.02 * random.gaussian();  // white around zero
    meter.add(next - heading);
    heading = next;
  }
  EXPECT_LT(meter.positive() + meter.negative(), 0.4);
}

TEST(SwingMeter, SumsEachWay) {
  SwingMeter meter{0.1};
  for (const double change : {0.5, -0.05, 0.05, 0.5, -2.0, 0.03, -1.0, 0.7}) { meter.add(change); }
  EXPECT_NEAR(meter.positive(), 1.0 + 0.7, 1e-12);
  EXPECT_NEAR(meter.negative(), 2.97 + 0.0, 1e-12);
}

TEST(Names, EveryParameterAndReasonHasOne) {
  for (int k = 0; k <= 12; ++k) { EXPECT_STRNE(to_string(static_cast<Parameter>(k)), "unknown"); }
  for (int k = 0; k <= 15; ++k) {
    EXPECT_STRNE(to_string(static_cast<RefusalReason>(k)), "unknown");
  }
  EXPECT_STREQ(to_string(static_cast<Parameter>(200)), "unknown");
  EXPECT_STREQ(to_string(static_cast<RefusalReason>(200)), "unknown");
}

}  // namespace
}  // namespace picolo
