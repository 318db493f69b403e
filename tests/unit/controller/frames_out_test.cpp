// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/frames_out.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace picolo {
namespace {

using Bytes = std::array<std::uint8_t, 8>;
constexpr FramesOutConfig kConfig{};

PoseEstimate at(double x_m, double y_m, double theta_rad) {
  PoseEstimate estimate;
  estimate.stamp = Timestamp{123ms};
  estimate.map_T_base = {x_m, y_m, theta_rad};
  return estimate;
}

TEST(FramesOut, GivenAPoseThenTheBytesOfTheTable) {
  const CanFrame frame = encode_pose(kConfig, at(1.2345, -2.0, 1.5));
  EXPECT_EQ(frame.id, 0x110U);
  EXPECT_FALSE(frame.extended);
  EXPECT_EQ(frame.length, 8);
  EXPECT_EQ(frame.stamp, Timestamp{123ms});
  // 1235 mm (halves away from zero) = 0x0004D3, -2000 mm = 0xFFF830, 15000 = 0x3A98
  EXPECT_EQ(frame.data, (Bytes{0xD3, 0x04, 0x00, 0x30, 0xF8, 0xFF, 0x98, 0x3A}));
}

TEST(FramesOut, GivenValuesBeyondTheFieldsThenClamped) {
  const CanFrame frame = encode_pose(kConfig, at(9000.0, -9000.0, -3.14159265));
  EXPECT_EQ(frame.data, (Bytes{0xFF, 0xFF, 0x7F, 0x01, 0x00, 0x80, 0x48, 0x85}));
}

TEST(FramesOut, GivenHealthThenTheBytesOfTheTable) {
  PoseEstimate estimate = at(0.0, 0.0, 0.0);
  estimate.state = HealthState::degraded;
  estimate.reason = HealthReason::lidar_silent;
  estimate.match_age = 1234ms;
  estimate.match_covariance = Matrix3f::diagonal(9e-4F, 16e-4F, 4e-4F);
  const CanFrame frame = encode_health(kConfig, estimate, 77);
  EXPECT_EQ(frame.id, 0x111U);
  EXPECT_EQ(frame.length, 8);
  EXPECT_EQ(frame.data, (Bytes{77, 2, 2, 123, 50, 0, 200, 0})) << "sigma 5 cm, 20 mrad";
}

TEST(FramesOut, GivenAnOldMatchAndNoNumberThenTheFieldsSayTheWorst) {
  PoseEstimate estimate = at(0.0, 0.0, 0.0);
  estimate.match_age = 1h;
  estimate.match_covariance =
      Matrix3f::diagonal(std::numeric_limits<float>::quiet_NaN(), 0.0F, -1.0F);
  const CanFrame frame = encode_health(kConfig, estimate, 0);
  EXPECT_EQ(frame.data, (Bytes{0, 0, 1, 255, 0xFF, 0xFF, 0xFF, 0xFF}));
  estimate.match_age = -5s;
  estimate.match_covariance = Matrix3f::diagonal(1e9F, 0.0F, 1e9F);
  EXPECT_EQ(encode_health(kConfig, estimate, 0).data, (Bytes{0, 0, 1, 0, 0xFF, 0xFF, 0xFF, 0xFF}));
}

TEST(FramesOut, GivenIdentifiersThatClashOrDoNotExistThenRefused) {
  EXPECT_TRUE(kConfig.valid());
  EXPECT_FALSE((FramesOutConfig{.pose_id = 0x110, .health_id = 0x110}.valid()));
  EXPECT_FALSE((FramesOutConfig{.pose_id = 0x800}.valid()));
  EXPECT_FALSE((FramesOutConfig{.health_id = 0x800}.valid()));
}

}  // namespace
}  // namespace picolo
