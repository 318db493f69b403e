// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/rplidar/rplidar_standard.hpp"

#include <algorithm>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int32_t kFullTurnQ6 = 360 * 64;
/// Real devices step by up to 9 degrees over what they cannot see; random bytes fall into this
/// window once in fifteen times.
constexpr std::int32_t kMaxStepQ6 = 12 * 64;
/// Just over 360 degrees happens, before the device subtracts its turn.
constexpr std::int32_t kMaxAngleQ6 = kFullTurnQ6 + 64;

bool near(std::int32_t from_q6, std::int32_t to_q6) {
  std::int32_t step = (to_q6 - from_q6) % kFullTurnQ6;
  if (step > kFullTurnQ6 / 2) { step -= kFullTurnQ6; }
  if (step < -kFullTurnQ6 / 2) { step += kFullTurnQ6; }
  return step <= kMaxStepQ6 && step >= -kMaxStepQ6;
}

}  // namespace

bool RplidarStandardDecoder::checked(std::size_t at) const {
  if (at + kNodeSize > size_) { return false; }
  const unsigned first = window_[at];
  return ((first ^ (first >> 1U)) & 1U) != 0 && (window_[at + 1] & 1U) != 0 &&
         angle_q6(at) <= kMaxAngleQ6;
}

std::int32_t RplidarStandardDecoder::angle_q6(std::size_t at) const {
  return load_u16_le(window_, at + 1) >> 1;
}

/// A node stands here, and the next one in step with it.
bool RplidarStandardDecoder::follows(std::size_t at) const {
  return checked(at) && checked(at + kNodeSize) && near(angle_q6(at), angle_q6(at + kNodeSize));
}

/// Everything from here to the end of the window is in step.
bool RplidarStandardDecoder::run(std::size_t at) const {
  bool any = false;
  for (; at + 2 * kNodeSize <= size_; at += kNodeSize) {
    if (!follows(at)) { return false; }
    any = true;
  }
  return any;
}

/// The stream goes on out of step right behind the front, so the front lost or gained a byte.
bool RplidarStandardDecoder::out_of_step_behind() const {
  if (size_ < 2 * kNodeSize || follows(0)) { return false; }
  constexpr std::array<std::size_t, 4> kSlipped{4, 3, 6, 7};
  return std::any_of(kSlipped.begin(), kSlipped.end(), [this](std::size_t at) {
    return follows(at) && near(last_angle_q6_, angle_q6(at));
  });
}

bool RplidarStandardDecoder::believable() const {
  if (!checked(0)) { return false; }
  if (locked_ && near(last_angle_q6_, angle_q6(0))) { return !out_of_step_behind(); }
  return run(0);  // first lock, or a piece of the stream is missing
}

Status RplidarStandardDecoder::accept() {
  last_angle_q6_ = angle_q6(0);
  locked_ = true;
  node_ = {.dist_mm_q2 = load_u16_le(window_, 3),
           .angle_z_q14 = static_cast<std::uint16_t>((last_angle_q6_ << 8) / 90),
           .quality = static_cast<std::uint8_t>(window_[0] & 0xFCU),
           .flag = static_cast<std::uint8_t>(window_[0] & 1U)};
  ++counters_.frames;
  std::copy(window_.begin() + kNodeSize, window_.begin() + static_cast<std::ptrdiff_t>(size_),
            window_.begin());
  size_ -= kNodeSize;
  return Status::ok;
}

Status RplidarStandardDecoder::reject() {
  if (locked_) { ++(checked(0) ? counters_.implausible : counters_.bad_checksums); }
  locked_ = false;
  ++counters_.skipped_bytes;
  std::copy(window_.begin() + 1, window_.begin() + static_cast<std::ptrdiff_t>(size_),
            window_.begin());
  --size_;
  return Status::not_ready;
}

Status RplidarStandardDecoder::push(std::uint8_t byte) {
  window_[size_] = byte;
  ++size_;
  if (size_ < window_.size()) { return Status::not_ready; }
  return believable() ? accept() : reject();
}

Status RplidarStandardDecoder::flush() {
  while (size_ >= kNodeSize) {
    const Status status = believable() ? accept() : reject();
    if (is_ok(status)) { return status; }
  }
  return Status::not_ready;
}

void RplidarStandardDecoder::reset() {
  size_ = 0;
  locked_ = false;
}

}  // namespace picolo::inline v0
