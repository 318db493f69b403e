// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/scip/scip_scan.hpp"

#include <algorithm>

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kStatusBytes = 4;  // "99b" and line feed
constexpr std::size_t kTimeBytes = 6;    // four characters, sum, line feed
constexpr std::size_t kHeadBytes = kStatusBytes + kTimeBytes;
constexpr std::size_t kLineBytes = kScipLineLength + 2;
constexpr std::size_t kRangeCharacters = 3;  // of the six of a range with intensity
/// How far a scan may be off its length: more than this is not a damaged byte here and there.
constexpr std::size_t kMaxSlip = 8;
constexpr std::uint32_t kMaxValue = 0xFFFF;

bool is_six_bits(std::uint8_t character) {
  return character >= 0x30 && character < 0x70;
}

}  // namespace

bool ScipScan::begin(const ScipCommand& command) {
  if (command.values() > kScipMaxValues) { return false; }
  command_ = command;
  values_.fill(0);
  has_time_ = false;
  next_position_ = 0;
  partial_ = 0;
  next_line_ = 0;
  good_lines_ = 0;
  return true;
}

std::size_t ScipScan::line_length(std::size_t index) const {
  return std::min(kScipLineLength, command_.characters() - index * kScipLineLength);
}

bool ScipScan::is_whole(std::size_t offset, ByteView text) const {
  if (text.size() < 2 || scip_sum(text.first(text.size() - 1)) != text.back()) { return false; }
  if (!std::all_of(text.begin(), text.end(), is_six_bits)) { return false; }
  if (offset + kTimeBytes / 2 < kHeadBytes) { return text.size() + 1 == kTimeBytes; }
  const std::size_t index = (offset + kLineBytes / 2 - kHeadBytes) / kLineBytes;
  return index >= next_line_ && index < lines() && text.size() == line_length(index) + 1;
}

bool ScipScan::line(std::size_t offset, ByteView text) {
  if (!is_whole(offset, text)) { return false; }
  if (offset + kTimeBytes / 2 < kHeadBytes) {
    time_ms_ = scip_number(text.first(4));
    has_time_ = true;
    return true;
  }
  const std::size_t index = (offset + kLineBytes / 2 - kHeadBytes) / kLineBytes;
  next_line_ = index + 1;
  ++good_lines_;
  read_values(index, text.first(text.size() - 1));
  return true;
}

void ScipScan::read_values(std::size_t index, ByteView text) {
  std::size_t position = index * kScipLineLength;
  for (const std::uint8_t character : text) {
    take(position, character);
    ++position;
  }
}

void ScipScan::take(std::size_t position, std::uint8_t character) {
  const std::size_t size = command_.value_size;
  const std::size_t place = position % size;
  const std::size_t range_size = std::min(size, kRangeCharacters);
  if (place >= range_size) { return; }  // intensity
  if (place == 0) {
    partial_ = 0;
  } else if (position != next_position_) {
    return;  // its beginning was lost with the line before
  }
  next_position_ = position + 1;
  partial_ = (partial_ << 6U) | ((character - 0x30U) & 0x3FU);
  if (place + 1 == range_size) {
    values_[position / size] = static_cast<std::uint16_t>(std::min(partial_, kMaxValue));
  }
}

bool ScipScan::may_end_at(std::size_t offset) const {
  const std::size_t full = kHeadBytes + command_.characters() + 2 * lines();
  return offset + kMaxSlip >= full;
}

bool ScipScan::complete(std::size_t offset) const {
  const std::size_t full = kHeadBytes + command_.characters() + 2 * lines();
  return good_lines_ > 0 && offset + kMaxSlip >= full && offset <= full + kMaxSlip;
}

}  // namespace picolo::inline v0
