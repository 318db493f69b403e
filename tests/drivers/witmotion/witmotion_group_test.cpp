// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/witmotion/witmotion_group.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace picolo::test {
namespace {

static_assert(WitMotionGroupConfig{}.valid());
static_assert(!WitMotionGroupConfig{.acceleration_full_scale_g = 0}.valid());
static_assert(!WitMotionGroupConfig{.max_spread = 0ms}.valid());

constexpr Duration kFrameTime = 955us;  // 11 bytes at 115200 baud

class WitMotionGroups : public testing::Test {
 protected:
  Result<ImuSample> add(int type, Timestamp stamp,
                        std::array<std::int16_t, 4> words = {1, 2, 3, 4}) {
    return group_.add({static_cast<WitMotionType>(type), words}, stamp, kFrameTime,
                      StampSource::kernel);
  }
  WitMotionGroup group_{WitMotionGroupConfig{}};
};

TEST_F(WitMotionGroups, GivenAccelerationAndRateThenOneSampleInSiUnitsStampedWithTheGroup) {
  EXPECT_EQ(add(0x51, Timestamp{1s}, {0, -16384, 2048, 0}).status(), Status::not_ready);
  const auto sample = add(0x52, Timestamp{1s} + kFrameTime, {32767, -16384, 0, 0});
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->stamp, Timestamp{1s});
  EXPECT_EQ(sample->source, StampSource::kernel);
  EXPECT_FLOAT_EQ(sample->acceleration_mps2[0], 0.0F);
  EXPECT_FLOAT_EQ(sample->acceleration_mps2[1], -8.0F * 9.80665F);
  EXPECT_FLOAT_EQ(sample->acceleration_mps2[2], 9.80665F);
  const float degree = std::numbers::pi_v<float> / 180.0F;
  EXPECT_FLOAT_EQ(sample->rate_radps[0], 2000.0F * degree * 32767.0F / 32768.0F);
  EXPECT_FLOAT_EQ(sample->rate_radps[1], -1000.0F * degree);
  EXPECT_FLOAT_EQ(sample->rate_radps[2], 0.0F);
}

TEST_F(WitMotionGroups, GivenATimeFrameFirstThenItOpensTheGroup) {
  EXPECT_FALSE(add(0x50, Timestamp{1s}));
  EXPECT_FALSE(add(0x51, Timestamp{1s} + kFrameTime));
  EXPECT_EQ(add(0x52, Timestamp{1s} + 2 * kFrameTime)->stamp, Timestamp{1s});
}

TEST_F(WitMotionGroups, GivenOtherFullScalesThenTheUnitsFollow) {
  WitMotionGroup group{
      WitMotionGroupConfig{.acceleration_full_scale_g = 2, .rate_full_scale_degps = 250}};
  static_cast<void>(group.add({WitMotionType::acceleration, {16384, 0, 0, 0}}, Timestamp{1s},
                              kFrameTime, StampSource::read));
  const auto sample = group.add({WitMotionType::rate, {16384, 0, 0, 0}}, Timestamp{1s}, kFrameTime,
                                StampSource::read);
  ASSERT_TRUE(sample);
  EXPECT_FLOAT_EQ(sample->acceleration_mps2[0], 9.80665F);
  EXPECT_FLOAT_EQ(sample->rate_radps[0], 125.0F * std::numbers::pi_v<float> / 180.0F);
}

TEST_F(WitMotionGroups, GivenAnAxisAtTheEndOfItsRangeThenTheSameSampleSaysSo) {
  for (const std::int16_t end : {std::int16_t{32767}, std::int16_t{-32768}, std::int16_t{-32767}}) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      WitMotionGroup group;
      std::array<std::int16_t, 4> words{1, 2, 3, end};  // the fourth word is no axis
      static_cast<void>(group.add({WitMotionType::acceleration, words}, Timestamp{1s}, kFrameTime,
                                  StampSource::read));
      EXPECT_FALSE(
          group.add({WitMotionType::rate, words}, Timestamp{1s}, kFrameTime, StampSource::read)
              ->saturated);
      words.at(axis) = end;
      static_cast<void>(group.add({WitMotionType::acceleration, words}, Timestamp{2s}, kFrameTime,
                                  StampSource::read));
      EXPECT_TRUE(
          group.add({WitMotionType::rate, {}}, Timestamp{2s}, kFrameTime, StampSource::read)
              ->saturated);
      static_cast<void>(group.add({WitMotionType::acceleration, {}}, Timestamp{3s}, kFrameTime,
                                  StampSource::read));
      EXPECT_TRUE(
          group.add({WitMotionType::rate, words}, Timestamp{3s}, kFrameTime, StampSource::read)
              ->saturated);
      EXPECT_EQ(group.counters().saturated, 2U);
    }
  }
}

TEST_F(WitMotionGroups, GivenALostFrameThenItsGroupGivesNoSampleAndIsCounted) {
  EXPECT_FALSE(add(0x51, Timestamp{1s}));
  EXPECT_FALSE(add(0x53, Timestamp{1s} + 2 * kFrameTime));  // rate lost
  EXPECT_FALSE(add(0x52, Timestamp{1s} + 11ms));            // acceleration lost
  EXPECT_FALSE(add(0x51, Timestamp{1s} + 20ms));
  EXPECT_TRUE(add(0x52, Timestamp{1s} + 21ms));
  EXPECT_EQ(group_.counters().incomplete, 2U);
  EXPECT_EQ(group_.counters().samples, 1U);
}

TEST_F(WitMotionGroups, GivenARateOfTheNextGroupBehindAnOldAccelerationThenTheyAreNotMixed) {
  EXPECT_FALSE(add(0x51, Timestamp{1s}));
  // Everything between was lost; by its type alone this frame could belong to the group.
  EXPECT_FALSE(add(0x52, Timestamp{1s} + 10ms + kFrameTime));
  EXPECT_EQ(group_.counters().incomplete, 1U);
}

TEST_F(WitMotionGroups, GivenStampsThatRunBackThenSampleStampsDoNot) {
  EXPECT_FALSE(add(0x51, Timestamp{1s}));
  EXPECT_EQ(add(0x52, Timestamp{1s} + kFrameTime)->stamp, Timestamp{1s});
  EXPECT_FALSE(add(0x51, Timestamp{1s} - 3ms));
  EXPECT_EQ(add(0x52, Timestamp{1s} - 2ms)->stamp, Timestamp{1s});
}

TEST_F(WitMotionGroups, GivenAnAngleFrameThenTheAnglesAreKeptBesideTheSamples) {
  EXPECT_EQ(group_.angles().stamp, Timestamp{});
  EXPECT_FALSE(add(0x51, Timestamp{1s}));
  EXPECT_TRUE(add(0x52, Timestamp{1s} + kFrameTime));
  EXPECT_FALSE(add(0x53, Timestamp{1s} + 2 * kFrameTime, {16384, -8192, -32768, 0x4682}));
  EXPECT_EQ(group_.angles().stamp, Timestamp{1s});
  EXPECT_FLOAT_EQ(group_.angles().angles_rad[0], std::numbers::pi_v<float> / 2);
  EXPECT_FLOAT_EQ(group_.angles().angles_rad[1], -std::numbers::pi_v<float> / 4);
  EXPECT_FLOAT_EQ(group_.angles().angles_rad[2], -std::numbers::pi_v<float>);
}

TEST_F(WitMotionGroups, GivenOtherFramesOfTheGroupThenTheyDoNotDisturb) {
  Timestamp stamp{1s};
  for (int type = 0x50; type <= 0x5A; ++type) {
    EXPECT_EQ(static_cast<bool>(add(type, stamp)), type == 0x52) << type;
    stamp += kFrameTime;
  }
  EXPECT_EQ(group_.counters().incomplete, 0U);
}

}  // namespace
}  // namespace picolo::test
