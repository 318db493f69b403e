// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ld06/ld06_decoder.hpp"

#include <numbers>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint32_t kIntervals = kLd06PointsPerPacket - 1;
constexpr std::uint32_t kFullTurn = kLd06FullTurnCdeg * kIntervals;
constexpr std::uint32_t kHalfTurn = kFullTurn / 2;
constexpr float kPi = std::numbers::pi_v<float>;

/// Clockwise in [0, full turn) to counter-clockwise in [-pi, pi].
float bearing_rad(std::uint32_t angle) {
  const auto clockwise = static_cast<std::int32_t>(angle);
  const std::int32_t centred =
      angle > kHalfTurn ? clockwise - static_cast<std::int32_t>(kFullTurn) : clockwise;
  return static_cast<float>(-centred) / static_cast<float>(kHalfTurn) * kPi;
}

}  // namespace

Status Ld06Decoder::push(std::uint8_t byte) {
  framer_.push(byte);
  if (!framer_.next()) { return Status::not_ready; }
  packet_ = parse_ld06(framer_.frame());
  return Status::ok;
}

void Ld06Readings::convert(const Ld06Packet& packet,
                           std::span<RangeReading, kLd06PointsPerPacket> readings) {
  const std::uint32_t start = packet.start_cdeg % kLd06FullTurnCdeg * kIntervals;
  const std::uint32_t span = span_cdeg(packet);
  for (std::size_t i = 0; i < kLd06PointsPerPacket; ++i) {
    const Ld06Point& point = packet.points[i];
    const std::uint32_t angle = (start + static_cast<std::uint32_t>(i) * span) % kFullTurn;
    const bool weak =
        point.intensity < config_.min_intensity && point.distance_mm > config_.weak_beyond_mm;
    readings[i].range_m = weak ? 0.0F : static_cast<float>(point.distance_mm) / 1000.0F;
    readings[i].bearing_rad = bearing_rad(angle);
    readings[i].starts_sweep = cutter_.passes_zero(angle);
  }
}

}  // namespace picolo::inline v0
