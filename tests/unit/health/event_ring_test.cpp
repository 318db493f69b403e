// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/localisation/event_ring.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

Event event(int number) {
  return {.stamp_us = number * 1000LL,
          .argument = number,
          .code = EventCode::pose_jump,
          .from = HealthState::tracking,
          .to = HealthState::degraded,
          .reason = HealthReason::lidar_silent};
}

struct EventRingTest : ::testing::Test {
  EventRing ring;
  void SetUp() override { ring.clear(); }
};

TEST_F(EventRingTest, GivenFewEventsThenAllAreHeldOldestFirst) {
  EXPECT_EQ(ring.size(), 0U);
  for (int i = 0; i < 3; ++i) { ring.push(event(i)); }
  ASSERT_EQ(ring.size(), 3U);
  EXPECT_EQ(ring[0].argument, 0);
  EXPECT_EQ(ring[2].argument, 2);
  EXPECT_EQ(ring[2].stamp(), Timestamp{2ms});
  EXPECT_EQ(ring.overwritten(), 0U);
}

TEST_F(EventRingTest, GivenMoreThanItHoldsThenTheOldestMadeRoomAndAreCounted) {
  for (int i = 0; i < 1000; ++i) { ring.push(event(i)); }
  ASSERT_EQ(ring.size(), EventRing::kCapacity);
  EXPECT_EQ(ring.total(), 1000U);
  EXPECT_EQ(ring.overwritten(), 1000U - 256U);
  for (std::size_t i = 0; i < ring.size(); ++i) {
    ASSERT_EQ(ring[i].argument, 744 + static_cast<int>(i));
  }
}

TEST_F(EventRingTest, GivenExactlyFullThenNothingIsOverwritten) {
  for (int i = 0; i < 256; ++i) { ring.push(event(i)); }
  EXPECT_EQ(ring.size(), 256U);
  EXPECT_EQ(ring.overwritten(), 0U);
  EXPECT_EQ(ring[0].argument, 0);
  EXPECT_EQ(ring[255].argument, 255);
}

TEST_F(EventRingTest, GivenMemoryThatCameThroughAResetThenAttachKeepsTheEvents) {
  for (int i = 0; i < 300; ++i) { ring.push(event(i)); }
  EventRing after_reset = ring;  // what the reset leaves in memory
  EXPECT_TRUE(after_reset.attach());
  EXPECT_EQ(after_reset.total(), 300U);
  EXPECT_EQ(after_reset[0].argument, 44);
  after_reset.push(event(300));
  EXPECT_EQ(after_reset[255].argument, 300);
}

TEST_F(EventRingTest, GivenAnEmptyRingThenAttachFindsNothing) {
  EXPECT_FALSE(ring.attach());
}

TEST_F(EventRingTest, GivenRandomMemoryThenAttachClears) {
  Random random{3};
  for (int round = 0; round < 50; ++round) {
    std::vector<unsigned char> noise(sizeof(EventRing));
    for (unsigned char& byte : noise) { byte = static_cast<unsigned char>(random.next_u32()); }
    if (round == 0) { std::fill(noise.begin(), noise.end(), static_cast<unsigned char>(0)); }
    if (round == 1) { std::fill(noise.begin(), noise.end(), static_cast<unsigned char>(0xFF)); }
    std::memcpy(&ring, noise.data(), noise.size());
    ASSERT_FALSE(ring.attach());
    ASSERT_EQ(ring.size(), 0U);
    ring.push(event(1));
    ASSERT_EQ(ring[0].argument, 1);
  }
}

TEST_F(EventRingTest, EveryCodeHasItsOwnName) {
  std::set<std::string> names;
  for (int i = 0; i <= 9; ++i) { names.insert(to_string(static_cast<EventCode>(i))); }
  EXPECT_EQ(names.size(), 10U);
  EXPECT_STREQ(to_string(static_cast<EventCode>(200)), "unknown");
}

}  // namespace
}  // namespace picolo
