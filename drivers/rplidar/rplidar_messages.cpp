// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/rplidar/rplidar_messages.hpp"

#include <algorithm>

#include "picolo/core/crc.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kStart = 0xA5;
constexpr std::uint8_t kAnswer = 0x5A;

/// What the devices answer, so that a descriptor among noise is not believed.
bool known(const RplidarDescriptor& descriptor) {
  switch (descriptor.type) {
    case 0x81: return descriptor.length == 5 && descriptor.mode == 1;
    case 0x82:
    case 0x85: return descriptor.length == 84 && descriptor.mode == 1;
    case 0x84: return descriptor.length == 132 && descriptor.mode == 1;
    case 0x04: return descriptor.length == 20 && descriptor.mode == 0;
    case 0x06: return descriptor.length == 3 && descriptor.mode == 0;
    case 0x15: return descriptor.length == 4 && descriptor.mode == 0;
    default: return false;
  }
}

}  // namespace

std::size_t encode_rplidar(RplidarCommand command, ByteView payload, std::span<std::uint8_t> out) {
  const std::size_t size = payload.empty() ? 2 : payload.size() + 4;
  if (out.size() < size) { return 0; }
  out[0] = kStart;
  out[1] = static_cast<std::uint8_t>(command);
  if (payload.empty()) { return size; }
  out[2] = static_cast<std::uint8_t>(payload.size());
  std::copy(payload.begin(), payload.end(), out.begin() + 3);
  out[size - 1] = xor8(out.first(size - 1));
  return size;
}

bool RplidarDescriptorFinder::push(std::uint8_t byte) {
  std::copy(last_.begin() + 1, last_.end(), last_.begin());
  last_.back() = byte;
  if (last_[0] != kStart || last_[1] != kAnswer) { return false; }
  const std::uint32_t word = load_u32_le(last_, 2);
  found_ = {.length = word & 0x3FFF'FFFFU,
            .mode = static_cast<std::uint8_t>(word >> 30U),
            .type = last_[6]};
  return known(found_);
}

}  // namespace picolo::inline v0
