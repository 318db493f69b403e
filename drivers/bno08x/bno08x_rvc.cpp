// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/bno08x/bno08x_rvc.hpp"

#include <algorithm>
#include <numbers>

#include "picolo/core/crc.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kHeader = 0xAA;
constexpr std::int32_t kHalfTurnCdeg = 18'000;
constexpr std::int32_t kQuarterTurnCdeg = 9'000;
constexpr float kMetresPerMilliG = 0.00980665F;
constexpr float kRadPerCdeg = std::numbers::pi_v<float> / 18'000.0F;

bool within(std::int16_t value, std::int32_t limit) {
  return value >= -limit && value <= limit;
}

}  // namespace

Bno08xRvcFrame parse_bno08x_rvc(ByteView bytes) {
  return {
      .index = bytes[2],
      .yaw_cdeg = load_i16_le(bytes, 3),
      .pitch_cdeg = load_i16_le(bytes, 5),
      .roll_cdeg = load_i16_le(bytes, 7),
      .acceleration_mg = {load_i16_le(bytes, 9), load_i16_le(bytes, 11), load_i16_le(bytes, 13)}};
}

FrameCheck Bno08xRvcFormat::check(ByteView bytes) const {
  if (bytes[0] != kHeader || (bytes.size() > 1 && bytes[1] != kHeader)) {
    return {FrameVerdict::no_header};
  }
  if (bytes.size() < kBno08xRvcFrameSize) { return {FrameVerdict::incomplete}; }
  if (sum8(bytes.subspan(2, 16)) != bytes[18]) { return {FrameVerdict::checksum}; }
  const Bno08xRvcFrame frame = parse_bno08x_rvc(bytes);
  const bool possible = within(frame.yaw_cdeg, kHalfTurnCdeg) &&
                        within(frame.pitch_cdeg, kQuarterTurnCdeg) &&
                        within(frame.roll_cdeg, kHalfTurnCdeg);
  if (!possible) { return {FrameVerdict::implausible}; }
  return {FrameVerdict::complete, kBno08xRvcFrameSize};
}

std::size_t Bno08xRvcProtocol::push(std::uint8_t byte, const ByteTime& time,
                                    std::span<ImuSample> samples) {
  frame_ready_ = false;
  framer_.push(byte);
  if (!framer_.next()) { return 0; }
  const Bno08xRvcFrame before = frame_;
  frame_ = parse_bno08x_rvc(framer_.frame());
  frame_ready_ = true;
  const auto steps = static_cast<std::uint8_t>(frame_.index - before.index);
  const bool follows = has_last_ && steps >= 1 && steps <= config_.max_gap;
  if (has_last_ && steps > 1) { counters_.missed += steps - 1U; }
  has_last_ = true;
  if (!follows) { return 0; }

  std::int32_t turned_cdeg = frame_.yaw_cdeg - before.yaw_cdeg;
  if (turned_cdeg > kHalfTurnCdeg) { turned_cdeg -= 2 * kHalfTurnCdeg; }
  if (turned_cdeg < -kHalfTurnCdeg) { turned_cdeg += 2 * kHalfTurnCdeg; }
  const Timestamp sent = time.first_bit(kBno08xRvcFrameSize + framer_.bytes_after_frame());
  ImuSample& sample = samples[0];
  sample = {.stamp = std::max(sent, last_stamp_), .source = time.source};
  last_stamp_ = sample.stamp;
  sample.rate_radps[2] = static_cast<float>(turned_cdeg) * kRadPerCdeg /
                         (to_seconds(config_.period) * static_cast<float>(steps));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int16_t mg = frame_.acceleration_mg[axis];
    sample.acceleration_mps2[axis] = static_cast<float>(mg) * kMetresPerMilliG;
    sample.saturated = sample.saturated || !within(mg, config_.saturated_from_mg - 1);
  }
  ++counters_.samples;
  if (sample.saturated) { ++counters_.saturated; }
  return 1;
}

void Bno08xRvcProtocol::interrupted() {
  framer_.reset();
  has_last_ = false;
}

SerialCounters Bno08xRvcProtocol::counters() const {
  return with_framer(counters_, framer_.counters());
}

}  // namespace picolo::inline v0
