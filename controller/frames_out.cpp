// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/frames_out.hpp"

#include <algorithm>

#include "picolo/core/bytes.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int64_t kMaxI24 = (1 << 23) - 1;

CanFrame empty_frame(std::uint16_t id, Timestamp stamp) {
  CanFrame frame;
  frame.stamp = stamp;
  frame.id = id;
  frame.length = 8;
  return frame;
}

void store_i24(CanFrame& frame, std::size_t offset, double value) {
  const auto bits = static_cast<std::uint32_t>(round_to_i64(value, -kMaxI24, kMaxI24));
  store_u16_le(frame.data, offset, static_cast<std::uint16_t>(bits & 0xFFFFU));
  frame.data[offset + 2] = static_cast<std::uint8_t>((bits >> 16) & 0xFFU);
}

void store_sigma(CanFrame& frame, std::size_t offset, float variance, float per_unit) {
  // A covariance that is no number must not look like certainty.
  const bool known = is_finite(variance) && variance >= 0.0F;
  const std::int32_t sigma =
      known ? round_to_i32(square_root(variance) * per_unit, 0, 0xFFFF) : 0xFFFF;
  store_u16_le(frame.data, offset, static_cast<std::uint16_t>(sigma));
}

}  // namespace

CanFrame encode_pose(const FramesOutConfig& config, const PoseEstimate& estimate) {
  CanFrame frame = empty_frame(config.pose_id, estimate.stamp);
  store_i24(frame, 0, estimate.map_T_base.x_m * 1000.0);
  store_i24(frame, 3, estimate.map_T_base.y_m * 1000.0);
  const std::int64_t yaw = round_to_i64(estimate.map_T_base.theta_rad * 10000.0, -32767, 32767);
  store_u16_le(frame.data, 6, static_cast<std::uint16_t>(yaw & 0xFFFF));
  return frame;
}

CanFrame encode_health(const FramesOutConfig& config, const PoseEstimate& estimate,
                       std::uint8_t counter) {
  CanFrame frame = empty_frame(config.health_id, estimate.stamp);
  frame.data[0] = counter;
  frame.data[1] = static_cast<std::uint8_t>(estimate.state);
  frame.data[2] = static_cast<std::uint8_t>(estimate.reason);
  const std::int64_t age_10ms = estimate.match_age / Duration{10'000};
  frame.data[3] = static_cast<std::uint8_t>(std::clamp<std::int64_t>(age_10ms, 0, 255));
  store_sigma(frame, 4, estimate.match_covariance(0, 0) + estimate.match_covariance(1, 1), 1000.0F);
  store_sigma(frame, 6, estimate.match_covariance(2, 2), 10000.0F);
  return frame;
}

}  // namespace picolo::inline v0
