// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A CAN bus that plays a scenario: frames arrive when the test says so, sent frames are kept,
/// failures come on demand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <vector>

#include "picolo/hal/can_bus.hpp"

namespace picolo::test {

/// `can_frame(Timestamp{5ms}, 0x181, {1, 2, 3, 4})`
inline CanFrame can_frame(Timestamp stamp, std::uint32_t id,
                          std::initializer_list<std::uint8_t> data = {}) {
  CanFrame frame{.stamp = stamp, .id = id, .length = static_cast<std::uint8_t>(data.size())};
  std::size_t i = 0;
  for (const std::uint8_t byte : data) { frame.data.at(i++) = byte; }
  return frame;
}

class FakeCanBus final : public CanBus {
 public:
  /// One more frame waits in the receive queue.
  void arrives(const CanFrame& frame) { waiting_.push_back(frame); }
  /// The controller is gone: waiting frames are lost, every call fails, until `reconnect`.
  void disconnect() {
    status_.rx_lost += static_cast<std::uint32_t>(waiting_.size());
    waiting_.clear();
    status_.state = CanState::absent;
  }
  void reconnect() { status_.state = CanState::active; }
  /// From now on `transmit` finds the queue full (or not).
  void send_queue_is_full(bool full) { send_queue_full_ = full; }
  void goes(CanState state) { status_.state = state; }

  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }
  [[nodiscard]] const std::vector<CanFrame>& sent() const { return sent_; }
  /// What was sent since the last call.
  [[nodiscard]] std::vector<CanFrame> take_sent() {
    std::vector<CanFrame> frames;
    frames.swap(sent_);
    return frames;
  }

  Result<CanFrame> receive() override {
    if (status_.state == CanState::absent) { return Status::disconnected; }
    if (waiting_.empty()) { return Status::not_ready; }
    const CanFrame frame = waiting_.front();
    waiting_.pop_front();
    ++status_.received;
    return frame;
  }

  Status transmit(const CanFrame& frame) override {
    if (status_.state == CanState::absent) { return Status::disconnected; }
    if (frame.length > 8 || frame.id > (frame.extended ? 0x1FFFFFFFU : 0x7FFU)) {
      return Status::invalid_argument;
    }
    if (send_queue_full_) {
      ++status_.tx_refused;
      return Status::full;
    }
    ++status_.transmitted;
    sent_.push_back(frame);
    return Status::ok;
  }

  [[nodiscard]] CanStatus status() const override { return status_; }

 private:
  std::deque<CanFrame> waiting_;
  std::vector<CanFrame> sent_;
  CanStatus status_{};
  bool send_queue_full_ = false;
};

}  // namespace picolo::test
