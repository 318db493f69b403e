// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What no device reports and nobody announces: a lidar that sees nothing, or too much; a vehicle
// that stands somewhere else than it thinks. The pose says so, and is never wrong without a word.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "picolo/sim/sim_byte_store.hpp"
#include "played_vehicle.hpp"

namespace picolo {
namespace {

using test::furnished_room;
using test::PlayedVehicle;
using State = HealthState;
using Reason = HealthReason;

const Pose2d kStart{-1.2, -1.6, 0.0};

// Elided: the vehicle is neither copied nor moved.
PlayedVehicle vehicle_at_start() {
  return PlayedVehicle{furnished_room(), kStart, PlayedVehicle::config_at(kStart)};
}

/// While the lidar says too little the odometry carries on; afterwards all is as before.
void expect_borne(PlayedVehicle& vehicle, const PlayedVehicle::See& see, Reason reason) {
  vehicle.start();
  vehicle.until(8s);
  ASSERT_EQ(vehicle.estimate().state, State::tracking);
  vehicle.see = see;
  vehicle.until(8s + 500ms);
  vehicle.until(12s, [&] {
    EXPECT_EQ(vehicle.estimate().state, State::degraded);
    EXPECT_EQ(vehicle.estimate().reason, reason);
  });
  EXPECT_LT(vehicle.error_m(), 0.1) << "odometry carries on";
  vehicle.see = {};
  vehicle.until(14s);
  EXPECT_EQ(vehicle.estimate().state, State::tracking);
  EXPECT_LT(vehicle.error_m(), 0.05);
  EXPECT_EQ(vehicle.silent_wrong, 0);
}

TEST(SpecialCases, GivenNoValidReturnThenDegradedOnOdometry) {
  PlayedVehicle vehicle = vehicle_at_start();
  expect_borne(
      vehicle, [](const Pose2d&, int, int) { return 0.0F; }, Reason::too_few_points);
}

TEST(SpecialCases, GivenFewerThanThirtyReturnsThenDegradedOnOdometry) {
  PlayedVehicle vehicle = vehicle_at_start();
  expect_borne(
      vehicle,
      [&](const Pose2d& at, int, int k) { return k % 13 == 0 ? vehicle.range_m(at, k) : 0.0F; },
      Reason::too_few_points);
}

TEST(SpecialCases, GivenAMirrorThenItsGhostRoomMovesNothing) {
  PlayedVehicle vehicle = vehicle_at_start();
  vehicle.start();
  vehicle.until(8s);
  // Beams to one side of the room come back from behind a wall: longer by the way to the ghost.
  vehicle.see = [&](const Pose2d& at, int, int k) {
    const double world = wrap_angle(at.theta_rad + static_cast<double>(vehicle.bearing_rad(k)));
    const double range = static_cast<double>(vehicle.range_m(at, k));
    if (std::abs(world - 0.1) > 0.4) { return static_cast<float>(range); }
    const double x = at.x_m + range * std::cos(world);
    const double y = at.y_m + range * std::sin(world);
    const double back = wrap_angle(0.2 + std::numbers::pi - world);
    const double ghost =
        test::cast(furnished_room(), x + 1e-3 * std::cos(back), y + 1e-3 * std::sin(back), back);
    return static_cast<float>(range + ghost);
  };
  double worst_m = 0.0;
  vehicle.until(20s, [&] { worst_m = std::max(worst_m, vehicle.error_m()); });
  EXPECT_LT(worst_m, 0.1);
  EXPECT_EQ(vehicle.silent_wrong, 0);
}

TEST(SpecialCases, GivenASweepMirroredLeftToRightThenThePoseIsNotBelieved) {
  PlayedVehicle vehicle = vehicle_at_start();
  vehicle.start();
  vehicle.until(8s);
  vehicle.see = [&](const Pose2d& at, int, int k) {
    return vehicle.range_m(at, PlayedVehicle::kBeams - 1 - k);
  };
  vehicle.until(8s + 500ms);
  vehicle.until(11s, [&] { EXPECT_NE(vehicle.estimate().state, State::tracking); });
  vehicle.see = {};
  vehicle.until(30s);
  EXPECT_EQ(vehicle.estimate().state, State::tracking);
  EXPECT_LT(vehicle.error_m(), 0.05);
  EXPECT_EQ(vehicle.silent_wrong, 0);
}

TEST(SpecialCases, GivenSweepsThatAreDuplicatedThenThePoseHolds) {
  PlayedVehicle vehicle = vehicle_at_start();
  vehicle.start();
  vehicle.until(8s);
  vehicle.repeats_sweeps = true;
  double worst_m = 0.0;
  vehicle.until(11s, [&] { worst_m = std::max(worst_m, vehicle.error_m()); });
  vehicle.repeats_sweeps = false;
  vehicle.until(20s);
  EXPECT_LT(worst_m, 0.2);
  EXPECT_EQ(vehicle.estimate().state, State::tracking);
  EXPECT_LT(vehicle.error_m(), 0.1);
  EXPECT_EQ(vehicle.silent_wrong, 0);
}

/// Within two sweeps and their match the state is not tracking; then the vehicle finds itself.
void expect_found(PlayedVehicle& vehicle, Duration moved_at) {
  bool relocalised = false;
  const Duration heard = moved_at + 300ms;
  vehicle.until(heard);
  EXPECT_NE(vehicle.estimate().state, State::tracking);
  vehicle.until(
      moved_at + 15s, [&] { relocalised |= vehicle.estimate().state == State::relocalising; },
      heard);
  EXPECT_TRUE(relocalised);
  EXPECT_EQ(vehicle.estimate().state, State::tracking);
  EXPECT_LT(vehicle.error_m(), 0.1);
  EXPECT_EQ(vehicle.robot().pipeline().localiser().counters().found_anywhere, 1U);
}

TEST(SpecialCases, GivenAKidnappedVehicleThenItFindsItselfInTheMapThatItMade) {
  const auto silent = [](const Pose2d& there) {
    PlayedVehicle vehicle = vehicle_at_start();
    vehicle.start();
    vehicle.until(19s);  // once around
    EXPECT_EQ(vehicle.estimate().state, State::tracking);
    vehicle.truth = there;
    vehicle.until(19s + 300ms);
    vehicle.silent_wrong = 0;  // nobody can know before two sweeps have shown it
    expect_found(vehicle, 19s);
    return vehicle.silent_wrong;
  };
  EXPECT_EQ(silent({-2.3, 1.2, -2.26}), 0);
  EXPECT_EQ(silent({1.3, -1.6, 0.69}), 0);
  EXPECT_EQ(silent({-0.4, 0.8, 2.55}), 0);
}

TEST(SpecialCases, GivenAWrongStartInALoadedMapThenNoTrackingBeforeItIsFound) {
  std::vector<std::uint8_t> memory(2 * 80 * 1024);
  sim::SimByteStore flash{memory, 4096, 8};
  {
    PlayedVehicle first = vehicle_at_start();
    first.start();
    first.until(19s);
    MapStore store{flash};
    ASSERT_EQ(store.begin_save(first.robot().pipeline().localiser().map()), Status::ok);
    Status status = Status::not_ready;
    while (status == Status::not_ready) { status = store.step(64); }
    ASSERT_EQ(status, Status::ok);
  }
  const Pose2d turned{-kStart.x_m, -kStart.y_m, std::numbers::pi};  // looks much alike
  for (const Pose2d& told : {Pose2d{2.0, 1.0, 1.5}, turned, Pose2d{30.0, 30.0, 0.0}, kStart}) {
    PlayedVehicle vehicle{furnished_room(), kStart, PlayedVehicle::config_at(told)};
    MapStore store{flash};
    ASSERT_EQ(vehicle.robot().load_map(store), Status::ok);
    vehicle.start();
    Duration tracking_since{0};
    for (Duration t = 100ms; t < 15s && tracking_since == Duration{0}; t += 100ms) {
      vehicle.until(t);
      if (vehicle.estimate().state == State::tracking) { tracking_since = t; }
    }
    EXPECT_GT(tracking_since, Duration{0});
    EXPECT_LT(vehicle.error_m(), 0.05) << told.x_m << ' ' << told.y_m;
    vehicle.until(tracking_since + 3s);
    EXPECT_EQ(vehicle.estimate().state, State::tracking);
    EXPECT_EQ(vehicle.silent_wrong, 0);
    std::printf("told (%.1f, %.1f): tracking after %.1f s\n", told.x_m, told.y_m,
                1e-6 * static_cast<double>(tracking_since.count()));
  }
}

}  // namespace
}  // namespace picolo
