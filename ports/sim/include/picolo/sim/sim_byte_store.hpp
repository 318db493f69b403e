// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Flash in RAM, with the power cut that stores are tested by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/random.hpp"
#include "picolo/hal/byte_store.hpp"

namespace picolo::inline v0::sim {

/// NOR flash over memory of the caller, erased at construction. Programming a granule twice clears
/// bits, as flash does, and is counted: good code never does it.
class SimByteStore final : public ByteStore {
 public:
  /// Precondition: memory.size() is a multiple of `sector`, and that of `granule`.
  SimByteStore(std::span<std::uint8_t> memory, std::size_t sector, std::size_t granule);

  [[nodiscard]] ByteStoreGeometry geometry() const override;
  Status read(std::size_t address, std::span<std::uint8_t> bytes) override;
  Status program(std::size_t address, std::span<const std::uint8_t> bytes) override;
  Status erase(std::size_t address) override;

  /// Power fails within the granule or sector that is written or erased after `operations` whole
  /// ones: a torn granule has some of its bits cleared, a torn sector is part old, part erased,
  /// part undefined, by `seed`. From then on every call gives `io_error`.
  void cut_power_after(std::uint32_t operations, std::uint64_t seed);
  /// The memory stays as the cut left it.
  void restore_power();
  [[nodiscard]] bool powered() const { return powered_; }
  /// Granules programmed and sectors erased so far: the number of places at which a cut makes a
  /// difference.
  [[nodiscard]] std::uint32_t operations() const { return operations_; }
  /// Granules that were programmed without having been erased.
  [[nodiscard]] std::uint32_t overwrites() const { return overwrites_; }
  /// The bytes as they are, for tests that damage them.
  [[nodiscard]] std::span<std::uint8_t> memory() { return memory_; }

 private:
  [[nodiscard]] bool inside(std::size_t address, std::size_t size) const;
  [[nodiscard]] bool power_fails_now();

  std::span<std::uint8_t> memory_;
  std::size_t sector_;
  std::size_t granule_;
  Random random_{1};
  bool powered_ = true;
  bool armed_ = false;
  std::uint32_t remaining_ = 0;
  std::uint32_t operations_ = 0;
  std::uint32_t overwrites_ = 0;
};

}  // namespace picolo::inline v0::sim
