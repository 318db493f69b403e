// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <vector>

#include "drives.hpp"
#include "picolo/core/random.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "support/fake_can_bus.hpp"
#include "support/property.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

using canopen::NodeState;

Timestamp at_ms(std::int64_t ms) {
  return Timestamp{Duration{ms * 1000}};
}

/// The recorded drives map velocity and position into TPDO2.
constexpr CanopenWheelsConfig navican() {
  CanopenWheelsConfig config = two_cia402_drives(1, 2);
  for (std::size_t i = 0; i < 2; ++i) {
    config.wheels[i].cob_id = canopen::tpdo_id(2, config.wheels[i].node);
    config.wheels[i].mapping = {
        {{canopen::kVelocityActual402, 0, 32}, {canopen::kPositionActual402, 0, 32}}};
    config.wheels[i].velocity_index = canopen::kVelocityActual402;
  }
  return config;
}
static_assert(navican().valid());

TEST(CanopenDevices, GivenTheRecordedStartUpOfTwoDrivesThenBootsDataAndPositionsAreSeen) {
  PICOLO_NEED_DATA("drivers/can/canopen_navican_cia402.candump");
  const auto frames = read_candump(data_path("drivers/can/canopen_navican_cia402.candump"));
  ASSERT_EQ(frames.size(), 44U);
  FakeCanBus bus;
  for (const CanFrame& frame : frames) { bus.arrives(frame); }
  CanopenWheels wheels{bus, navican()};
  const auto sample = wheels.poll(100);
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->restarted);
  EXPECT_EQ(sample->stamp, Timestamp{1s} + 38ms);
  EXPECT_EQ(wheels.node(0).boots, 1U);
  EXPECT_EQ(wheels.node(1).boots, 1U);
  EXPECT_EQ(wheels.node(0).state, NodeState::operational);
  // The drives stood at -2 and 1; ten and twenty counts on, the count has moved by just that.
  EXPECT_TRUE(wheels.consume(tpdo(at_ms(1050), 0x281, -77, 8)));
  EXPECT_TRUE(wheels.consume(tpdo(at_ms(1050), 0x282, 99, 21)));
  const auto next = wheels.take();
  ASSERT_TRUE(next);
  EXPECT_EQ(next->ticks[0] - sample->ticks[0], 10);
  EXPECT_EQ(next->ticks[1] - sample->ticks[1], 20);
  EXPECT_EQ(wheels.velocity(0), -77);
  EXPECT_EQ(wheels.velocity(1), 99);
  EXPECT_EQ(wheels.poll(100).status(), Status::not_ready);
  EXPECT_EQ(wheels.counters().foreign, 44U - 4U);
}

TEST(CanopenDevices, GivenTheTrafficOfCarsThenAllOfItIsForeign) {
  PICOLO_NEED_DATA("drivers/can/savvycan_thinkcity_candump.log");
  for (const char* name : {"drivers/can/savvycan_thinkcity_candump.log",
                           "drivers/can/test_nissan_leaf_traffic.candump"}) {
    FakeCanBus bus;
    CanopenWheels wheels{bus, two_cia402_drives(0x3D, 0x3E)};  // 0x1BD, 0x1BE: nobody's
    std::uint32_t frames = 0;
    for (const CanFrame& frame : read_candump(data_path(name))) {
      ++frames;
      static_cast<void>(wheels.consume(frame));
    }
    EXPECT_GT(frames, 10'000U);
    EXPECT_EQ(wheels.counters().foreign, frames);
    EXPECT_EQ(wheels.take().status(), Status::not_ready);
  }
}

TEST(CanopenDevices, GivenADualDriveThenOneFrameIsASampleAndOneNodeIsWatched) {
  FakeCanBus bus;
  CanopenWheels wheels{bus, dual_cia402_drive(7)};
  EXPECT_EQ(wheels.node_count(), 1U);
  bus.arrives(tpdo(at_ms(10), 0x187, -100, 200));
  bus.arrives(sync_at(at_ms(20)));
  bus.arrives(tpdo(at_ms(21), 0x187, -90, 205));
  bus.arrives(can_frame(at_ms(30), 0x187, {1, 2, 3, 4, 5, 6, 7}));
  EXPECT_EQ(wheels.poll(10)->stamp, at_ms(10));
  const auto sample = wheels.poll(10);
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->stamp, at_ms(20));
  EXPECT_EQ(sample->ticks[0], 10);
  EXPECT_EQ(sample->ticks[1], 5);
  EXPECT_EQ(wheels.poll(10).status(), Status::not_ready);
  EXPECT_EQ(wheels.counters().short_frames, 1U) << "once a frame, not once a wheel";
  EXPECT_EQ(wheels.counters().process_data, 2U);
  EXPECT_EQ(wheels.filters().size(), 4U);
  wheels.request_start();
  EXPECT_EQ(wheels.service(at_ms(40)), Status::ok);
  ASSERT_EQ(bus.sent().size(), 1U);
  EXPECT_EQ(bus.sent()[0].data[1], 7);
}

TEST(CanopenDevices, GivenADualDriveThatRestartsThenBothWheelsAreRebased) {
  FakeCanBus bus;
  CanopenWheels wheels{bus, dual_cia402_drive(7)};
  ASSERT_TRUE(wheels.consume(tpdo(at_ms(10), 0x187, 1000, 2000)));
  ASSERT_TRUE(wheels.take());
  ASSERT_TRUE(wheels.consume(heartbeat(at_ms(15), 7, kBootUp)));
  ASSERT_TRUE(wheels.consume(tpdo(at_ms(20), 0x187, 0, 0)));
  const auto sample = wheels.take();
  ASSERT_TRUE(sample);
  EXPECT_TRUE(sample->restarted);
  EXPECT_EQ(sample->ticks[0], 0);
  EXPECT_EQ(sample->ticks[1], 0);
}

TEST(CanopenDevices, GivenAbsoluteEncodersWithAnyRangeThenWrapsAndMountingAreUndone) {
  for (const std::uint64_t modulus :
       {1ULL << 32, 1ULL << 24, 1ULL << 25, 1ULL << 29, 1'000'003ULL, 36'000ULL}) {
    CanopenWheelsConfig config = two_cia406_encoders(3, 4, modulus);
    config.wheels[1].counter.inverted = true;
    ASSERT_TRUE(config.valid());
    FakeCanBus bus;
    CanopenWheels wheels{bus, config};
    Random random{modulus};
    const auto range = static_cast<std::int64_t>(modulus);
    std::int64_t left = 0;
    std::int64_t right = 0;
    for (int k = 1; k <= 2000; ++k) {
      if (k > 1) {
        left += 900 + static_cast<std::int64_t>(random.below(5000));
        right += static_cast<std::int64_t>(random.below(20'000)) - 9000;
      }
      const std::int64_t left_position = (left + range - 5) % range;
      const std::int64_t right_position = ((range - 1 - right) % range + range) % range;
      ASSERT_TRUE(wheels.consume(tpdo(at_ms(10 * k), 0x183, left_position)));
      ASSERT_TRUE(wheels.consume(tpdo(at_ms(10 * k) + 250us, 0x184, right_position)));
      const auto sample = wheels.take();
      ASSERT_TRUE(sample);
      ASSERT_EQ(sample->ticks[0], left) << "modulus " << modulus;
      ASSERT_EQ(sample->ticks[1], right) << "modulus " << modulus;
    }
  }
}

TEST(CanopenDevices, GivenAPositionBeyondTheRangeOfTheEncoderThenItIsCountedAndIgnored) {
  FakeCanBus bus;
  CanopenWheels wheels{bus, two_cia406_encoders(3, 4, 36'000)};
  ASSERT_TRUE(wheels.consume(tpdo(at_ms(10), 0x183, 36'000)));
  ASSERT_TRUE(wheels.consume(tpdo(at_ms(10), 0x184, 35'999)));
  EXPECT_EQ(wheels.take().status(), Status::not_ready);
  EXPECT_EQ(wheels.counters().out_of_range, 1U);
}

TEST(CanopenDevices, GivenASpeedLimitThenAnUnannouncedRestartIsCountedAndTold) {
  CanopenWheelsConfig config = two_cia402_drives(1, 2);
  config.wheels[0].counter.max_counts_per_s = 10'000;
  FakeCanBus bus;
  CanopenWheels wheels{bus, config};
  for (int k = 1; k <= 3; ++k) {
    ASSERT_TRUE(wheels.consume(tpdo(at_ms(10 * k), 0x181, k == 3 ? 0 : 1'000'000 + k)));
    ASSERT_TRUE(wheels.consume(tpdo(at_ms(10 * k), 0x182, k)));
    const auto sample = wheels.take();
    ASSERT_TRUE(sample);
    EXPECT_EQ(sample->restarted, k != 2);
    EXPECT_EQ(sample->ticks[0], k == 1 ? 0 : 1);
  }
  EXPECT_EQ(wheels.counters().jumps, 1U);
}

TEST(CanopenDevices, GivenConfigurationsThatCannotWorkThenTheyAreRefused) {
  EXPECT_FALSE(two_cia402_drives(0, 2).valid());
  EXPECT_FALSE(two_cia402_drives(1, 128).valid());
  EXPECT_FALSE(two_cia402_drives(1, 1).valid()) << "both wheels would read the same object";
  EXPECT_FALSE(two_cia406_encoders(1, 2, 1).valid());
  CanopenWheelsConfig config = two_cia402_drives(1, 2);
  config.wheels[0].position_index = 0x6063;
  EXPECT_FALSE(config.valid()) << "not in the mapping";
  config = two_cia402_drives(1, 2);
  config.wheels[0].mapping = {{{0x6064, 0, 16}}};
  EXPECT_FALSE(config.valid()) << "16 bits cannot count to 2^32";
  config.wheels[0].counter.modulus = 1U << 16;
  EXPECT_TRUE(config.valid());
  config.wheels[0].velocity_index = 0x606C;
  EXPECT_FALSE(config.valid());
  config = two_cia402_drives(1, 2);
  config.wheels[0].cob_id = 0x085;
  EXPECT_FALSE(config.valid()) << "an emergency's identifier";
  config = two_cia402_drives(1, 2);
  config.wheels[1].cob_id = 0x181;
  EXPECT_FALSE(config.valid()) << "two nodes cannot send one identifier";
  config = two_cia402_drives(1, 2);
  config.wheel_count = 5;
  EXPECT_FALSE(config.valid());
  config = two_cia402_drives(1, 2);
  config.sync_counter_overflow = 1;
  EXPECT_FALSE(config.valid());
}

TEST(CanopenDevices, GivenAConfigurationWithoutPositionAllTheSameThenNothingIsDecoded) {
  CanopenWheelsConfig config = two_cia402_drives(1, 2);
  for (auto& wheel : config.wheels) { wheel.position_index = 0x6063; }
  FakeCanBus bus;
  CanopenWheels wheels{bus, config};
  EXPECT_TRUE(wheels.consume(tpdo(at_ms(10), 0x181, 5)));
  EXPECT_TRUE(wheels.consume(tpdo(at_ms(10), 0x182, 5)));
  EXPECT_EQ(wheels.take().status(), Status::not_ready);
}

/// What goes in as counts of an encoder comes out as motion, whatever the bus does in between.
TEST(CanopenDevices, PropertyEncodedPositionsComeBackAsCounts) {
  EXPECT_TRUE(rc::check([] {
    const auto steps =
        *rc::gen::container<std::vector<std::int32_t>>(rc::gen::inRange(-1'000'000, 1'000'000));
    const auto start = *rc::gen::arbitrary<std::int32_t>();
    FakeCanBus bus;
    CanopenWheels wheels{bus, two_cia402_drives(1, 2)};
    std::int64_t position = start;
    std::int64_t k = 1;
    for (const std::int32_t step : steps) {
      bus.arrives(sync_at(at_ms(10 * k)));
      bus.arrives(tpdo(at_ms(10 * k) + 700us, 0x182, -position));
      bus.arrives(can_frame(at_ms(10 * k), 0x201, {1, 2}));
      bus.arrives(tpdo(at_ms(10 * k) + 100us, 0x181, position));
      const auto sample = wheels.poll(4);
      RC_ASSERT(static_cast<bool>(sample));
      RC_ASSERT(sample->stamp == at_ms(10 * k));
      RC_ASSERT(sample->ticks[0] == position - start);
      RC_ASSERT(sample->ticks[1] == start - position);
      position += step;
      ++k;
    }
  }));
}

}  // namespace
}  // namespace picolo::test
