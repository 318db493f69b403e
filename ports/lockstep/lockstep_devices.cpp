// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/lockstep/lockstep_devices.hpp"

#include <algorithm>

namespace picolo::inline v0::lockstep {
namespace {

/// Moves what is left to the front.
template <typename T, std::size_t Capacity>
void forget_taken(FixedVector<T, Capacity>& waiting, std::size_t& next) {
  const std::size_t left = waiting.size() - next;
  for (std::size_t i = 0; i < left; ++i) { waiting[i] = waiting[next + i]; }
  (void)waiting.resize(left);
  next = 0;
}

}  // namespace

Result<CanFrame> LockstepCanBus::receive() {
  if (next_ == waiting_.size()) { return Status::not_ready; }
  ++status_.received;
  return waiting_[next_++];
}

Status LockstepCanBus::transmit(const CanFrame& frame) {
  if (frame.length > 8 || frame.id > 0x7FF || frame.extended) { return Status::invalid_argument; }
  if (!sent_.push_back(frame)) {
    ++status_.tx_refused;
    return Status::full;
  }
  ++status_.transmitted;
  return Status::ok;
}

void LockstepCanBus::begin_frame() {
  forget_taken(waiting_, next_);
  sent_.clear();
}

void LockstepCanBus::arrives(const CanFrame& frame) {
  if (!waiting_.push_back(frame)) { ++status_.rx_lost; }
}

Result<SerialRead> LockstepSerialPort::read(std::span<std::uint8_t> buffer) {
  const std::size_t size = std::min(buffer.size(), waiting_.size() - next_);
  if (size == 0) { return Status::not_ready; }
  for (std::size_t i = 0; i < size; ++i) { buffer[i] = waiting_[next_ + i].byte; }
  next_ += size;
  return SerialRead{size, waiting_[next_ - 1].stamp, StampSource::hardware};
}

Result<std::size_t> LockstepSerialPort::write(std::span<const std::uint8_t> bytes) {
  return bytes.size();
}

void LockstepSerialPort::begin_frame() {
  forget_taken(waiting_, next_);
}

void LockstepSerialPort::arrives(std::uint8_t byte, Timestamp stamp) {
  if (!waiting_.push_back({stamp, byte})) { ++lost_; }
}

}  // namespace picolo::inline v0::lockstep
