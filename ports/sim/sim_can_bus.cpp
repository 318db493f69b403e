// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/sim_can_bus.hpp"

#include <algorithm>

namespace picolo::inline v0::sim {
namespace {

bool is_valid(const CanFrame& frame) {
  const std::uint32_t max_id = frame.extended ? 0x1FFF'FFFFU : 0x7FFU;
  return frame.length <= 8 && frame.id <= max_id;
}

}  // namespace

Duration frame_time(const CanFrame& frame, std::uint32_t bit_rate) {
  const std::int64_t overhead_bits = frame.extended ? 67 : 47;  // with interframe space
  const std::int64_t data_bits = frame.remote ? 0 : 8 * std::int64_t{frame.length};
  return Duration{(overhead_bits + data_bits) * 1'000'000 / std::int64_t{bit_rate}};
}

SimCanBus::SimCanBus(Clock& clock, std::uint32_t bit_rate) : clock_(clock), bit_rate_(bit_rate) {}

Result<CanFrame> SimCanBus::receive() {
  if (status_.state == CanState::absent) { return Status::disconnected; }
  if (to_firmware_.empty() || to_firmware_.front().stamp > clock_.now()) {
    return Status::not_ready;
  }
  const CanFrame frame = to_firmware_.front();
  to_firmware_.pop();
  ++status_.received;
  return frame;
}

Status SimCanBus::transmit(const CanFrame& frame) {
  if (!is_valid(frame)) { return Status::invalid_argument; }
  if (status_.state == CanState::absent) { return Status::disconnected; }
  if (status_.state == CanState::bus_off || from_firmware_.room() == 0) {
    ++status_.tx_refused;
    return Status::full;
  }
  CanFrame sent = frame;
  sent.source = StampSource::hardware;
  sent.stamp = occupy(clock_.now(), frame);
  static_cast<void>(from_firmware_.push(sent));  // room was checked
  ++status_.transmitted;
  if (listener_ != nullptr) { listener_->heard(sent, true); }
  return Status::ok;
}

CanStatus SimCanBus::status() const {
  return status_;
}

Timestamp SimCanBus::deliver(const CanFrame& frame) {
  CanFrame passed = frame;
  passed.source = StampSource::hardware;
  passed.stamp = occupy(frame.stamp, frame);
  if (listener_ != nullptr) { listener_->heard(passed, false); }
  const bool deaf = status_.state == CanState::absent || status_.state == CanState::bus_off;
  if (!deaf && !to_firmware_.push(passed)) { ++status_.rx_lost; }
  return passed.stamp;
}

Result<CanFrame> SimCanBus::take_sent(Timestamp until) {
  if (from_firmware_.empty() || from_firmware_.front().stamp > until) { return Status::not_ready; }
  const CanFrame frame = from_firmware_.front();
  from_firmware_.pop();
  return frame;
}

void SimCanBus::set_state(CanState state) {
  if (status_.state == CanState::bus_off && state != CanState::bus_off) { ++status_.restarts; }
  if (state == CanState::absent || state == CanState::bus_off) {
    to_firmware_.clear();
    from_firmware_.clear();
  }
  status_.state = state;
}

Timestamp SimCanBus::occupy(Timestamp earliest, const CanFrame& frame) {
  free_from_ = std::max(earliest, free_from_) + frame_time(frame, bit_rate_);
  return free_from_;
}

}  // namespace picolo::inline v0::sim
