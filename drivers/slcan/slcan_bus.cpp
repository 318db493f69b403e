// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/slcan/slcan_bus.hpp"

#include <algorithm>

namespace picolo::inline v0 {
namespace {

constexpr int kChunksInOneCall = 4;
// An adapter that was reset meanwhile refuses every frame.
constexpr std::uint32_t kRefusalsOfAClosedAdapter = 8;

}  // namespace

Result<CanFrame> SlcanBus::receive() {
  if (status_.state != CanState::absent) { (void)send_rest(); }  // tried again in the next call
  for (int i = 0; i < kChunksInOneCall; ++i) {
    const Result<CanFrame> frame = next_in_chunk();
    if (frame) { return frame; }
    next_ = 0;
    const Status status = chunk_.read(port_, SerialChunk::kCapacity);
    follow(status);
    if (!is_ok(status)) { return status; }
    look_for_lost_bytes();
  }
  return next_in_chunk();
}

Status SlcanBus::transmit(const CanFrame& frame) {
  if (frame.length > 8 || frame.id > (frame.extended ? 0x1FFF'FFFFU : 0x7FFU)) {
    return Status::invalid_argument;
  }
  const Status rest = send_rest();
  if (rest == Status::disconnected) { return rest; }
  if (!is_ok(rest)) {
    ++status_.tx_refused;
    return Status::full;
  }
  slcan::Line line = slcan::encode(frame);
  (void)line.add(slcan::kEnd);  // fits: what we send carries no time
  queue(line.view());
  if (flush() == Status::disconnected) { return Status::disconnected; }
  ++status_.transmitted;
  return Status::ok;
}

/// What is unsent, then, to an adapter that is not open, the words that open it. `ok`: all is sent.
Status SlcanBus::send_rest() {
  const Status status = flush();
  if (!is_ok(status) || open_) { return status; }
  // The first end closes whatever half a line the adapter has.
  const auto rate = static_cast<std::uint8_t>(config_.command());
  const std::array<std::uint8_t, 8> words{slcan::kEnd, 'C',         slcan::kEnd, 'S',
                                          rate,        slcan::kEnd, 'O',         slcan::kEnd};
  queue(words);
  open_ = true;
  refusals_in_a_row_ = 0;
  const Status sent = flush();
  counters_.opened += open_ ? 1U : 0U;
  return sent;
}

void SlcanBus::queue(ByteView bytes) {
  std::copy(bytes.begin(), bytes.end(), unsent_.begin());
  unsent_size_ = bytes.size();
}

/// `ok`: nothing is unsent.
Status SlcanBus::flush() {
  if (unsent_size_ == 0) { return Status::ok; }
  const Result<std::size_t> taken = port_.write(std::span{unsent_}.first(unsent_size_));
  follow(taken.status());
  if (!taken) { return taken.status(); }
  const auto rest = unsent_.begin() + static_cast<std::ptrdiff_t>(*taken);
  std::copy(rest, unsent_.begin() + static_cast<std::ptrdiff_t>(unsent_size_), unsent_.begin());
  unsent_size_ -= *taken;
  return unsent_size_ == 0 ? Status::ok : Status::full;
}

/// Follows the line's coming and going.
void SlcanBus::follow(Status status) {
  if (status != Status::disconnected) {
    status_.state = CanState::active;
    return;
  }
  status_.state = CanState::absent;
  open_ = false;
  unsent_size_ = 0;
  cutter_ = {};
  line_size_ = 0;
}

void SlcanBus::look_for_lost_bytes() {
  const std::uint32_t lost = port_.lost();
  if (lost == port_lost_) { return; }
  port_lost_ = lost;
  ++status_.rx_lost;
  cutter_.spoil();
}

/// `not_ready`: the chunk is used up.
Result<CanFrame> SlcanBus::next_in_chunk() {
  while (next_ < chunk_.size()) {
    const std::size_t at = next_;
    ++next_;
    ++line_size_;
    const slcan::LineCutter::Event event = cutter_.add(chunk_[at]);
    const std::size_t size = line_size_;
    if (slcan::ends_line(chunk_[at])) { line_size_ = 0; }  // that of a spoilt one, too
    if (event == slcan::LineCutter::Event::none) { continue; }
    if (event == slcan::LineCutter::Event::overlong) {
      ++counters_.malformed;
      ++status_.rx_lost;
      continue;
    }
    if (event == slcan::LineCutter::Event::refused) {
      ++counters_.refused;
      ++refusals_in_a_row_;
      if (refusals_in_a_row_ >= kRefusalsOfAClosedAdapter) { open_ = false; }
      continue;
    }
    Result<CanFrame> frame = take_line();
    if (!frame) { continue; }
    CanFrame stamped = *frame;
    last_stamp_ = std::max(last_stamp_, chunk_.first_bit(at, size));
    stamped.stamp = last_stamp_;
    stamped.source = chunk_.source();
    ++status_.received;
    return stamped;
  }
  return Status::not_ready;
}

Result<CanFrame> SlcanBus::take_line() {
  const Result<CanFrame> frame = slcan::decode(cutter_.line());
  if (frame.status() == Status::invalid_argument) {
    ++counters_.malformed;
    ++status_.rx_lost;
  } else {
    refusals_in_a_row_ = 0;
    counters_.answers += frame ? 0U : 1U;
  }
  return frame;
}

}  // namespace picolo::inline v0
