// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "can_frame_words.hpp"

namespace picolo::inline v0::zcu102 {
namespace {

constexpr std::uint32_t kExtended = 1U << 19;
constexpr std::uint32_t kStandardRemote = 1U << 20;  // set in every extended frame
constexpr std::uint32_t kExtendedRemote = 1U << 0;

std::uint32_t id_bits(std::uint32_t id, bool extended) {
  return extended ? ((id >> 18) << 21) | ((id & 0x3'FFFFU) << 1) : id << 21;
}

std::uint32_t pack(const CanFrame& frame, std::size_t first) {
  std::uint32_t word = 0;
  for (std::size_t i = first; i < first + 4; ++i) {
    word = (word << 8) | (i < frame.length ? frame.data[i] : 0U);
  }
  return word;
}

}  // namespace

CanWords to_words(const CanFrame& frame) {
  CanWords words{.id = id_bits(frame.id, frame.extended),
                 .length = std::uint32_t{frame.length} << 28,
                 .data_high = pack(frame, 0),
                 .data_low = pack(frame, 4)};
  if (frame.extended) { words.id |= kExtended | kStandardRemote; }
  if (frame.remote) { words.id |= frame.extended ? kExtendedRemote : kStandardRemote; }
  return words;
}

CanFrame to_frame(const CanWords& words) {
  CanFrame frame{.extended = (words.id & kExtended) != 0};
  const std::uint32_t high = words.id >> 21;
  frame.id = frame.extended ? (high << 18) | ((words.id >> 1) & 0x3'FFFFU) : high;
  frame.remote = (words.id & (frame.extended ? kExtendedRemote : kStandardRemote)) != 0;
  const std::uint32_t length = words.length >> 28;
  frame.length = static_cast<std::uint8_t>(length > 8 ? 8 : length);
  for (std::size_t i = 0; i < 8; ++i) {
    const std::uint32_t word = i < 4 ? words.data_high : words.data_low;
    frame.data[i] = static_cast<std::uint8_t>(word >> (24 - 8 * (i % 4)));
  }
  return frame;
}

FilterWords to_words(const CanFilter& filter) {
  FilterWords words{.mask = id_bits(filter.mask, filter.extended) | kExtended,
                    .id = id_bits(filter.id, filter.extended)};
  words.mask |= filter.extended ? kExtendedRemote : kStandardRemote;
  if (filter.extended) { words.id |= kExtended; }
  return words;
}

}  // namespace picolo::inline v0::zcu102
