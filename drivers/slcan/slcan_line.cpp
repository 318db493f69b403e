// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/slcan/slcan_line.hpp"

namespace picolo::inline v0::slcan {
namespace {

constexpr std::uint8_t kNoDigit = 0xFF;

void add_digits(Line& line, std::uint32_t value, int digits) {
  for (int i = digits - 1; i >= 0; --i) {
    const std::uint32_t digit = (value >> (4 * i)) & 0xFU;
    (void)line.add(static_cast<std::uint8_t>(digit < 10 ? '0' + digit : 'A' + digit - 10));
  }
}

constexpr std::uint8_t digit_of(std::uint8_t text) {
  if (text >= '0' && text <= '9') { return static_cast<std::uint8_t>(text - '0'); }
  if (text >= 'A' && text <= 'F') { return static_cast<std::uint8_t>(text - 'A' + 10); }
  if (text >= 'a' && text <= 'f') { return static_cast<std::uint8_t>(text - 'a' + 10); }
  return kNoDigit;
}

bool read_digits(ByteView line, std::size_t at, std::size_t digits, std::uint32_t& value) {
  if (at + digits > line.size()) { return false; }
  value = 0;
  for (std::size_t i = 0; i < digits; ++i) {
    const std::uint8_t digit = digit_of(line[at + i]);
    if (digit == kNoDigit) { return false; }
    value = (value << 4) | digit;
  }
  return true;
}

}  // namespace

Line encode(const CanFrame& frame) {
  Line line;
  if (frame.extended) {
    (void)line.add(frame.remote ? 'R' : 'T');
  } else {
    (void)line.add(frame.remote ? 'r' : 't');
  }
  add_digits(line, frame.id, frame.extended ? 8 : 3);
  add_digits(line, frame.length, 1);
  for (std::size_t i = 0; i < frame.length && !frame.remote; ++i) {
    add_digits(line, frame.data[i], 2);
  }
  return line;
}

Result<CanFrame> decode(ByteView line) {
  if (line.empty()) { return Status::not_ready; }
  const std::uint8_t type = line[0];
  const bool extended = type == 'T' || type == 'R';
  const bool remote = type == 'r' || type == 'R';
  if (!extended && !remote && type != 't') {
    // z and Z: sent. V, N, F: version, serial number, status flags.
    const bool answer = type == 'z' || type == 'Z' || type == 'V' || type == 'N' || type == 'F';
    return answer ? Status::not_ready : Status::invalid_argument;
  }
  CanFrame frame{.extended = extended, .remote = remote};
  const std::size_t id_digits = extended ? 8 : 3;
  std::uint32_t length = 0;
  if (!read_digits(line, 1, id_digits, frame.id) || !read_digits(line, 1 + id_digits, 1, length) ||
      length > 8 || frame.id > (extended ? 0x1FFF'FFFFU : 0x7FFU)) {
    return Status::invalid_argument;
  }
  frame.length = static_cast<std::uint8_t>(length);
  std::size_t at = 2 + id_digits;
  for (std::size_t i = 0; i < length && !remote; ++i, at += 2) {
    std::uint32_t byte = 0;
    if (!read_digits(line, at, 2, byte)) { return Status::invalid_argument; }
    frame.data[i] = static_cast<std::uint8_t>(byte);
  }
  std::uint32_t milliseconds = 0;  // of the adapter's clock, when somebody switched them on
  const bool ends = at == line.size();
  const bool timed = at + 4 == line.size() && read_digits(line, at, 4, milliseconds);
  if (!ends && !timed) { return Status::invalid_argument; }
  return frame;
}

LineCutter::Event LineCutter::add(std::uint8_t byte) {
  if (ended_) {
    line_.clear();
    ended_ = false;
  }
  if (ends_line(byte)) {
    const bool spoilt = spoilt_;
    spoilt_ = false;
    ended_ = true;
    if (spoilt) { line_.clear(); }
    if (spoilt) { return Event::none; }
    return byte == kEnd ? Event::line : Event::refused;
  }
  if (spoilt_ || line_.add(byte)) { return Event::none; }
  spoilt_ = true;
  return Event::overlong;
}

}  // namespace picolo::inline v0::slcan
