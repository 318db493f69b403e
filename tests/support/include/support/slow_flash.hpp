// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Flash that erases in the background.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "picolo/hal/byte_store.hpp"

namespace picolo::test {

/// An erase is done when somebody has asked for it, or for anything that has to wait for it, so
/// often.
class SlowFlash final : public ByteStore {
 public:
  SlowFlash(ByteStore& flash, int askings) : flash_(flash), askings_(askings) {}

  [[nodiscard]] ByteStoreGeometry geometry() const override { return flash_.geometry(); }
  Status read(std::size_t address, std::span<std::uint8_t> bytes) override {
    return flash_.read(address, bytes);
  }
  Status program(std::size_t address, std::span<const std::uint8_t> bytes) override {
    if (at_work()) { return Status::not_ready; }
    return flash_.program(address, bytes);
  }
  Status erase(std::size_t address) override {
    if (at_work()) { return Status::not_ready; }
    if (is_blank(address)) { return Status::ok; }
    const Status status = flash_.erase(address);
    if (status != Status::ok) { return status; }
    left_ = askings_;
    ++erases;
    return Status::not_ready;
  }

  std::uint32_t erases = 0;
  std::uint32_t waits = 0;  ///< calls that were answered `not_ready` by work under way

 private:
  bool is_blank(std::size_t address) {
    std::vector<std::uint8_t> sector(geometry().sector);
    return flash_.read(address, sector) == Status::ok &&
           std::ranges::all_of(sector, [](std::uint8_t byte) { return byte == 0xFF; });
  }
  bool at_work() {
    if (left_ == 0) { return false; }
    --left_;
    ++waits;
    return true;
  }

  ByteStore& flash_;
  int askings_;
  int left_ = 0;
};

}  // namespace picolo::test
