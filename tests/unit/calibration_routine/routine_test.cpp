// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/calibration_routine.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "commissioning.hpp"
#include "picolo/sim/sim_byte_store.hpp"

namespace picolo {
namespace {

using test::Commissioning;
using test::Leg;
using test::Truth;
using test::Wiring;

std::array<double, 6> values(const DriveParameters& d) {
  return {d.radius_left_m,    d.radius_right_m,   d.track_m,
          d.base_T_lidar.x_m, d.base_T_lidar.y_m, d.base_T_lidar.theta_rad};
}

struct Flash {
  std::vector<std::uint8_t> memory = std::vector<std::uint8_t>(512);
  sim::SimByteStore device{memory, 256, 8};
  CalibrationStore store{device};
};

std::string told(CalibrationRoutine& routine) {
  return std::string{to_string(routine.phase())} + ": " + to_string(routine.refusal().parameter) +
         ": " + to_string(routine.refusal().reason);
}

TEST(CalibrationRoutine, ADriverWhoFollowsTheAdviceGetsTheTruthStored) {
  const Truth truth;
  const auto t = values(truth.drive);
  const std::array<double, 6> limits{1e-3 * t[0], 1e-3 * t[1], 1e-3 * t[2],
                                     0.002,       0.002,       0.1 * 3.14159265 / 180.0};
  double longest_s = 0.0;
  int within = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Flash flash;
    Commissioning drive{truth, seed, {}, &flash.store};
    drive.follow_advice();
    ASSERT_EQ(drive.routine().phase(), CalibrationPhase::done)
        << seed << ' ' << told(drive.routine()) << " at " << drive.now_s();
    longest_s = std::max(longest_s, drive.now_s());
    CalibrationRecord record;
    ASSERT_EQ(flash.store.load(record), Status::ok);
    const auto found = values(record.drive);
    for (std::size_t k = 0; k < 6; ++k) {
      EXPECT_NEAR(found[k], t[k], 4.0 * record.drive_std[k])
          << "parameter " << k << " seed " << seed;
      within += std::abs(found[k] - t[k]) <= limits[k] ? 1 : 0;
    }
    EXPECT_NEAR(record.time_offset_s, truth.lidar_age_s, 0.001);
    EXPECT_NEAR(record.gyro_bias_radps, truth.gyro_bias_radps, 0.001);
    EXPECT_NEAR(record.gyro_scale, truth.gyro_scale, 0.002);
    EXPECT_NEAR(record.gyro_offset_s, truth.gyro_age_s, 0.003);
  }
  EXPECT_GE(within, 57) << "of 60: two standard deviations are the accuracy asked for";
  std::printf("longest commissioning %.0f s, routine %zu bytes\n", longest_s,
              sizeof(CalibrationRoutine));
  static_assert(sizeof(CalibrationRoutine) < 27U * 1024U);
}

struct Insufficient {
  const char* name;
  std::vector<Leg> legs;
  Wiring wiring;
  RefusalReason reason;
  Parameter parameter;
};

const std::vector<Leg> kGood{{5, 5, 6},  {-2, 2, 6}, {4, 6, 6},  {2, -2, 6}, {6, 4, 6},
                             {-2, 2, 2}, {5, 5, 6},  {2, -2, 3}, {3, 5, 6},  {5, 3, 6}};

class Refused : public ::testing::TestWithParam<Insufficient> {};

TEST_P(Refused, WithTheReasonAndTheParameterAndNothingStored) {
  const Insufficient& given = GetParam();
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Flash flash;
    CalibrationRecord old;
    old.drive = {0.07, 0.07, 0.4, {0.1, 0.2, 0.3}};
    ASSERT_EQ(flash.store.begin_save(old), Status::ok);
    while (flash.store.step(8) == Status::not_ready) {}
    const std::vector<std::uint8_t> before = flash.memory;
    Commissioning drive{{}, seed, {}, &flash.store};
    drive.wire(given.wiring);
    drive.begin();
    drive.drive(given.legs);
    drive.finish();
    ASSERT_EQ(drive.routine().phase(), CalibrationPhase::refused);
    const bool primary = drive.routine().refusal() == Refusal{given.reason, given.parameter};
    EXPECT_TRUE(primary || drive.routine().lacks(given.parameter) == given.reason)
        << told(drive.routine());
    EXPECT_EQ(flash.memory, before) << "the old calibration is untouched";
  }
}

INSTANTIATE_TEST_SUITE_P(
    Classes, Refused,
    ::testing::Values(Insufficient{"StandingStill",
                                   {{0, 0, 40}},
                                   Wiring::right,
                                   RefusalReason::standing_still,
                                   Parameter::wheel_radius_left},
                      Insufficient{"StraightOnly",
                                   {{5, 5, 40}},
                                   Wiring::right,
                                   RefusalReason::straight_only,
                                   Parameter::track_width},
                      Insufficient{"PureRotation",
                                   {{-2, 2, 20}, {2, -2, 20}},
                                   Wiring::right,
                                   RefusalReason::pure_rotation,
                                   Parameter::wheel_radius_left},
                      Insufficient{"ConstantArc",
                                   {{4, 6, 60}},
                                   Wiring::right,
                                   RefusalReason::constant_arc,
                                   Parameter::track_width},
                      Insufficient{"OneTurnDirection",
                                   {{5, 5, 20}, {4, 6, 20}, {3, 6, 20}},
                                   Wiring::right,
                                   RefusalReason::one_turn_direction,
                                   Parameter::track_width},
                      Insufficient{"TooLittleData",
                                   {{4, 6, 1}, {6, 4, 1}},
                                   Wiring::right,
                                   RefusalReason::too_little_data,
                                   Parameter::wheel_radius_left},
                      Insufficient{"YawWithoutTranslation",
                                   {{-2, 2, 20}, {2, -2, 20}},
                                   Wiring::right,
                                   RefusalReason::no_translation,
                                   Parameter::lidar_yaw},
                      Insufficient{"LeftDisconnected", kGood, Wiring::left_dead,
                                   RefusalReason::encoder_disconnected,
                                   Parameter::wheel_radius_left},
                      Insufficient{"RightDisconnected", kGood, Wiring::right_dead,
                                   RefusalReason::encoder_disconnected,
                                   Parameter::wheel_radius_right},
                      Insufficient{"Swapped", kGood, Wiring::swapped,
                                   RefusalReason::encoder_swapped, Parameter::wheel_radius_left},
                      Insufficient{"LeftReversed", kGood, Wiring::left_reversed,
                                   RefusalReason::encoder_reversed, Parameter::wheel_radius_left},
                      Insufficient{"RightReversed", kGood, Wiring::right_reversed,
                                   RefusalReason::encoder_reversed, Parameter::wheel_radius_right},
                      Insufficient{"ClockAtConstantVelocity",
                                   {{5, 5, 60}},
                                   Wiring::right,
                                   RefusalReason::constant_velocity,
                                   Parameter::time_offset}),
    [](const auto& param) { return std::string{param.param.name}; });

TEST(CalibrationRoutine, WithoutGyroItDoesWithout) {
  Truth truth;
  truth.has_gyro = false;
  Commissioning drive{truth, 5};
  drive.follow_advice();
  EXPECT_EQ(drive.routine().phase(), CalibrationPhase::done) << told(drive.routine());
  EXPECT_EQ(drive.routine().record().gyro_scale, 1.0);
}

TEST(CalibrationRoutine, FreshDataThatContradictsIsRefused) {
  Flash flash;
  Commissioning drive{{}, 6, {}, &flash.store};
  drive.begin();
  while (drive.routine().phase() == CalibrationPhase::collecting) { drive.drive(drive.advised()); }
  ASSERT_EQ(drive.routine().phase(), CalibrationPhase::verifying) << told(drive.routine());
  DriveParameters flat_tyre = Truth{}.drive;
  flat_tyre.radius_left_m *= 0.93;
  drive.change(flat_tyre);
  while (drive.routine().running()) { drive.drive(drive.advised()); }
  EXPECT_EQ(drive.routine().refusal().reason, RefusalReason::inconsistent) << told(drive.routine());
  CalibrationRecord record;
  EXPECT_EQ(flash.store.load(record), Status::not_ready) << "nothing was stored";
}

TEST(CalibrationRoutine, AbortLeavesTheStoreAloneAndANewStartForgets) {
  Flash flash;
  Commissioning drive{{}, 7, {}, &flash.store};
  drive.begin();
  drive.drive(kGood);
  EXPECT_EQ(drive.routine().start(drive.now()), Status::full);
  EXPECT_EQ(drive.routine().cancel(), Status::ok);
  EXPECT_EQ(drive.routine().cancel(), Status::not_ready);
  EXPECT_EQ(drive.routine().finish(), Status::not_ready);
  EXPECT_EQ(drive.routine().phase(), CalibrationPhase::aborted);
  EXPECT_EQ(drive.routine().refusal().reason, RefusalReason::aborted);
  CalibrationRecord record;
  EXPECT_EQ(flash.store.load(record), Status::not_ready);
  drive.follow_advice(drive.now_s() + 900.0);
  EXPECT_EQ(drive.routine().phase(), CalibrationPhase::done) << told(drive.routine());
}

TEST(CalibrationRoutine, AStorageThatFailsIsARefusal) {
  std::vector<std::uint8_t> memory(128);
  sim::SimByteStore small{memory, 64, 8};
  CalibrationStore store{small};
  Commissioning drive{{}, 8, {}, &store};
  drive.follow_advice();
  EXPECT_EQ(drive.routine().refusal().reason, RefusalReason::not_stored) << told(drive.routine());
}

TEST(CalibrationRoutine, ProgressGrowsAndEachPhaseHasAName) {
  Commissioning drive{{}, 9};
  drive.begin();
  EXPECT_EQ(drive.routine().percent(Parameter::track_width), 0);
  drive.drive(kGood);
  const auto early = drive.routine().percent(Parameter::track_width);
  EXPECT_GT(early, 0);
  drive.drive(kGood);
  EXPECT_GT(drive.routine().percent(Parameter::track_width), early);
  for (int k = 0; k <= 9; ++k) {
    EXPECT_STRNE(to_string(static_cast<CalibrationPhase>(k)), "unknown");
  }
  for (int k = 0; k <= 6; ++k) { EXPECT_STRNE(to_string(static_cast<DriveAdvice>(k)), "unknown"); }
}

TEST(CalibrationRoutine, NeverStandingStillIsRefusedByName) {
  Commissioning drive{{}, 10};
  static_cast<void>(drive.routine().start(drive.now()));
  drive.drive(Leg{3, 4, 90});
  EXPECT_EQ(drive.routine().refusal(),
            (Refusal{RefusalReason::too_little_data, Parameter::gyro_bias}));
}

}  // namespace
}  // namespace picolo
