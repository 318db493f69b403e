// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/rplidar/rplidar_capsule_finder.hpp"

#include <algorithm>

#include "picolo/core/crc.hpp"

namespace picolo::inline v0 {
namespace {

constexpr unsigned kFirstSync = 0xA;
constexpr unsigned kSecondSync = 0x5;

FrameVerdict check_header(ByteView bytes) {
  if (bytes.empty()) { return FrameVerdict::incomplete; }
  if ((bytes[0] >> 4U) != kFirstSync) { return FrameVerdict::no_header; }
  if (bytes.size() == 1) { return FrameVerdict::incomplete; }
  return (bytes[1] >> 4U) == kSecondSync ? FrameVerdict::complete : FrameVerdict::no_header;
}

}  // namespace

FrameVerdict RplidarCapsuleFinder::check(std::size_t offset) const {
  if (offset >= size_) { return FrameVerdict::incomplete; }
  const ByteView bytes = ByteView{window_}.subspan(offset, size_ - offset);
  const FrameVerdict header = check_header(bytes);
  if (header != FrameVerdict::complete) { return header; }
  if (bytes.size() < capsule_size_) { return FrameVerdict::incomplete; }
  const unsigned sum = xor8(bytes.subspan(2, capsule_size_ - 2));
  const unsigned expected = (bytes[0] & 0xFU) | ((bytes[1] & 0xFU) << 4U);
  return sum == expected ? FrameVerdict::complete : FrameVerdict::checksum;
}

/// The capsule that stands in line and overlaps the one at the front, which does not.
FrameVerdict RplidarCapsuleFinder::rival() const {
  if (!has_last_) { return FrameVerdict::no_header; }
  return check(capsule_size_ - (position_ - last_position_) % capsule_size_);
}

/// What the bytes behind the capsule say of it.
FrameVerdict RplidarCapsuleFinder::confirmation() const {
  return check_header(ByteView{window_}.subspan(capsule_size_, size_ - capsule_size_));
}

bool RplidarCapsuleFinder::stands_in_line() const {
  return has_last_ && (position_ - last_position_) % capsule_size_ == 0;
}

bool RplidarCapsuleFinder::hand_out() {
  handed_out_ = true;
  has_last_ = true;
  last_position_ = position_;
  ++counters_.frames;
  return true;
}

void RplidarCapsuleFinder::drop(std::size_t bytes) {
  std::copy(window_.data() + bytes, window_.data() + size_, window_.data());
  size_ -= bytes;
  position_ += static_cast<std::uint32_t>(bytes);
  was_complete_ = false;
  handed_out_ = false;
}

bool RplidarCapsuleFinder::push(std::uint8_t byte) {
  completed_bytes_ = 0;
  window_[size_] = byte;
  ++size_;
  while (size_ > 0) {
    const FrameVerdict verdict = was_complete_ ? FrameVerdict::complete : check(0);
    if (verdict == FrameVerdict::incomplete) { return false; }
    if (verdict != FrameVerdict::complete) {
      counters_.bad_checksums += verdict == FrameVerdict::checksum ? 1U : 0U;
      ++counters_.skipped_bytes;
      drop(1);
      continue;
    }
    if (!was_complete_) { completed_bytes_ = size_; }
    was_complete_ = true;
    if (!handed_out_ && stands_in_line()) { return hand_out(); }
    const FrameVerdict confirmed = confirmation();
    if (confirmed == FrameVerdict::incomplete) { return false; }
    if (confirmed == FrameVerdict::complete && handed_out_) {
      drop(capsule_size_);
      continue;
    }
    if (confirmed == FrameVerdict::complete) {
      const FrameVerdict other = rival();
      if (other == FrameVerdict::incomplete) { return false; }
      if (other != FrameVerdict::complete) { return hand_out(); }
    }
    // Not counted as skipped: most of it may have been handed out in good faith.
    counters_.implausible += handed_out_ ? 0U : 1U;
    drop(1);
  }
  return false;
}

void RplidarCapsuleFinder::reset(std::size_t capsule_size) {
  capsule_size_ = capsule_size;
  size_ = 0;
  was_complete_ = false;
  handed_out_ = false;
  has_last_ = false;
}

}  // namespace picolo::inline v0
