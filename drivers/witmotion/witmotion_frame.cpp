// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/witmotion/witmotion_frame.hpp"

#include "picolo/core/crc.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kHeader = 0x55;
constexpr std::uint8_t kTypeMask = 0xF0;
constexpr std::uint8_t kTypeHigh = 0x50;

}  // namespace

WitMotionFrame parse_witmotion(ByteView bytes) {
  WitMotionFrame frame{.type = static_cast<WitMotionType>(bytes[1])};
  for (std::size_t i = 0; i < frame.words.size(); ++i) {
    frame.words[i] = load_i16_le(bytes, 2 + 2 * i);
  }
  return frame;
}

FrameCheck WitMotionFormat::check(ByteView bytes) const {
  if (bytes[0] != kHeader) { return {FrameVerdict::no_header}; }
  if (bytes.size() > 1 && (bytes[1] & kTypeMask) != kTypeHigh) { return {FrameVerdict::no_header}; }
  if (bytes.size() < kWitMotionFrameSize) { return {FrameVerdict::incomplete}; }
  if (sum8(bytes.first(kWitMotionFrameSize - 1)) != bytes[kWitMotionFrameSize - 1]) {
    return {FrameVerdict::checksum};
  }
  return {FrameVerdict::complete, kWitMotionFrameSize};
}

Status WitMotionDecoder::push(std::uint8_t byte) {
  framer_.push(byte);
  if (!framer_.next()) { return Status::not_ready; }
  frame_ = parse_witmotion(framer_.frame());
  return Status::ok;
}

}  // namespace picolo::inline v0
