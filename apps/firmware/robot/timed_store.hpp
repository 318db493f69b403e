// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Flash whose sectors take their time to erase, over memory that takes none.
#pragma once

#include <algorithm>
#include <array>

#include "picolo/hal/byte_store.hpp"
#include "picolo/hal/clock.hpp"

namespace picolo {

/// `waits`: `erase` returns when it is done, as with flash that the program itself runs from.
/// Otherwise it answers `not_ready` meanwhile.
class TimedStore final : public ByteStore {
 public:
  TimedStore(ByteStore& store, Clock& clock, Duration erase_time, bool waits)
      : store_(store), clock_(clock), erase_time_(erase_time), waits_(waits) {}

  [[nodiscard]] ByteStoreGeometry geometry() const override { return store_.geometry(); }
  Status read(std::size_t address, std::span<std::uint8_t> bytes) override {
    return store_.read(address, bytes);
  }
  Status program(std::size_t address, std::span<const std::uint8_t> bytes) override {
    return at_work() ? Status::not_ready : store_.program(address, bytes);
  }
  Status erase(std::size_t address) override {
    if (at_work()) { return Status::not_ready; }
    if (is_blank(address)) { return Status::ok; }
    const Status status = store_.erase(address);
    if (!is_ok(status)) { return status; }
    ++erases_;
    done_ = clock_.now() + erase_time_;
    if (!waits_) { return Status::not_ready; }
    while (at_work()) {}
    return Status::ok;
  }
  [[nodiscard]] std::uint32_t erases() const { return erases_; }

 private:
  bool at_work() { return clock_.now() < done_; }
  bool is_blank(std::size_t address) {
    std::array<std::uint8_t, 256> piece{};
    for (std::size_t at = 0; at < geometry().sector; at += piece.size()) {
      if (!is_ok(store_.read(address + at, piece))) { return false; }
      if (std::ranges::any_of(piece, [](std::uint8_t byte) { return byte != 0xFF; })) {
        return false;
      }
    }
    return true;
  }

  ByteStore& store_;
  Clock& clock_;
  Duration erase_time_;
  bool waits_;
  Timestamp done_{};
  std::uint32_t erases_ = 0;
};

}  // namespace picolo
