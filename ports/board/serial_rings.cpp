// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/board/serial_rings.hpp"

namespace picolo::inline v0::board {
namespace {

std::uint32_t low_word(Timestamp stamp) {
  return static_cast<std::uint32_t>(stamp.time_since_epoch().count() & 0xFFFF'FFFF);
}

}  // namespace

void SerialRings::received(std::uint8_t byte, Timestamp now) {
  arrived_ = arrived_ + 1;
  (void)received_.push((low_word(now) << 8) | byte);  // counts what it refuses
}

void SerialRings::overrun() {
  overruns_ = overruns_ + 1;
}

Result<SerialRead> SerialRings::read(std::span<std::uint8_t> buffer, Clock& clock) {
  std::uint32_t word = 0;
  std::size_t size = 0;
  while (size < buffer.size() && received_.pop(word)) {
    buffer[size] = static_cast<std::uint8_t>(word & 0xFFU);
    ++size;
  }
  if (size == 0) { return Status::not_ready; }
  const Timestamp now = clock.now();  // after the last byte was taken: none is younger
  const std::uint32_t age_us = (low_word(now) - (word >> 8)) & kStampMask;
  return SerialRead{
      .size = size, .last_byte_stamp = now - Duration{age_us}, .source = StampSource::hardware};
}

Result<std::size_t> SerialRings::write(std::span<const std::uint8_t> bytes) {
  // This end alone fills the ring: what is free now stays free.
  const std::size_t room = SpscRing<std::uint8_t, kSend>::capacity() - to_send_.size();
  std::size_t taken = 0;
  while (taken < bytes.size() && taken < room) {
    (void)to_send_.push(bytes[taken]);
    ++taken;
  }
  if (taken == 0 && !bytes.empty()) { return Status::full; }
  return taken;
}

}  // namespace picolo::inline v0::board
