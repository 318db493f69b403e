// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/undistort/pose_buffer.hpp"

#include <gtest/gtest.h>

namespace picolo {
namespace {

Timestamp at_ms(int ms) {
  return Timestamp{Duration{ms * 1000}};
}

TEST(PoseBuffer, EmptyKnowsNothing) {
  const PoseBuffer<4> buffer;
  EXPECT_EQ(buffer.at(at_ms(0)).status(), Status::not_ready);
}

TEST(PoseBuffer, InterpolatesBetweenAndNeverBeyond) {
  PoseBuffer<8> buffer;
  ASSERT_EQ(buffer.push({at_ms(10), {0.0, 0.0, 3.0}}), Status::ok);
  ASSERT_EQ(buffer.push({at_ms(20), {1.0, 2.0, -3.0}}), Status::ok);
  EXPECT_EQ(buffer.at(at_ms(9)).status(), Status::out_of_range);
  EXPECT_EQ(buffer.at(at_ms(21)).status(), Status::not_ready);
  EXPECT_EQ(*buffer.at(at_ms(10)), (Pose2d{0.0, 0.0, 3.0}));
  EXPECT_EQ(*buffer.at(at_ms(20)), (Pose2d{1.0, 2.0, -3.0}));
  const Result<Pose2d> quarter = buffer.at(Timestamp{Duration{12500}});
  ASSERT_TRUE(quarter);
  EXPECT_DOUBLE_EQ(quarter->x_m, 0.25);
  EXPECT_DOUBLE_EQ(quarter->y_m, 0.5);
  EXPECT_NEAR(quarter->theta_rad, 3.0 + 0.25 * (2 * 3.14159265358979324 - 6.0), 1e-12);
}

TEST(PoseBuffer, RefusesPosesThatAreNotNewer) {
  PoseBuffer<4> buffer;
  ASSERT_EQ(buffer.push({at_ms(10), {1.0, 0.0, 0.0}}), Status::ok);
  EXPECT_EQ(buffer.push({at_ms(10), {2.0, 0.0, 0.0}}), Status::out_of_range);
  EXPECT_EQ(buffer.push({at_ms(5), {2.0, 0.0, 0.0}}), Status::out_of_range);
  EXPECT_EQ(buffer.size(), 1U);
  EXPECT_EQ(buffer.at(at_ms(10))->x_m, 1.0);
}

TEST(PoseBuffer, OldestMakesRoomAndEveryHeldInstantIsFound) {
  PoseBuffer<5> buffer;
  for (int i = 0; i < 23; ++i) {
    ASSERT_EQ(buffer.push({at_ms(10 * i), {1.0 * i, 0.0, 0.0}}), Status::ok);
  }
  EXPECT_EQ(buffer.size(), 5U);
  EXPECT_EQ(buffer.at(at_ms(179)).status(), Status::out_of_range);
  for (int ms = 180; ms <= 220; ++ms) { EXPECT_NEAR(buffer.at(at_ms(ms))->x_m, 0.1 * ms, 1e-12); }
  buffer.clear();
  EXPECT_EQ(buffer.at(at_ms(200)).status(), Status::not_ready);
  EXPECT_EQ(buffer.push({at_ms(1), {}}), Status::ok);
}

}  // namespace
}  // namespace picolo
