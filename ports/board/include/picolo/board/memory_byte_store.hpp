// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Flash emulated in memory that a reset leaves alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/hal/byte_store.hpp"

namespace picolo::inline v0::board {

/// A store over memory that the linker script places and start-up code neither loads nor clears
/// (battery-backed SRAM, FRAM). The last granule tells such memory from random bytes and is not
/// part of the store's use: memory without it is erased at construction.
class MemoryByteStore final : public ByteStore {
 public:
  /// Precondition: memory.size() is a multiple of `sector`, at least three of them, and `sector`
  /// one of `kGranule`.
  MemoryByteStore(std::span<std::uint8_t> memory, std::size_t sector);

  /// One sector less than the memory.
  [[nodiscard]] ByteStoreGeometry geometry() const override;
  Status read(std::size_t address, std::span<std::uint8_t> bytes) override;
  Status program(std::size_t address, std::span<const std::uint8_t> bytes) override;
  Status erase(std::size_t address) override;
  /// The memory was there already.
  [[nodiscard]] bool survived() const { return survived_; }

  static constexpr std::size_t kGranule = 8;

 private:
  [[nodiscard]] bool inside(std::size_t address, std::size_t size) const;

  std::span<std::uint8_t> store_;
  std::size_t sector_;
  bool survived_;
};

}  // namespace picolo::inline v0::board
