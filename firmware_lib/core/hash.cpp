// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/hash.hpp"

#include <bit>

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

void Hash::add_bytes(std::span<const std::uint8_t> bytes) {
  constexpr std::uint64_t kPrime = 0x100000001B3ULL;
  for (const std::uint8_t byte : bytes) { state_ = (state_ ^ byte) * kPrime; }
}

void Hash::add(std::uint64_t word) {
  std::uint8_t bytes[8];
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(word & 0xFFU);
    word >>= 8;
  }
  add_bytes(bytes);
}

void Hash::add(std::uint32_t word) {
  std::uint8_t bytes[4];
  for (std::uint8_t& byte : bytes) {
    byte = static_cast<std::uint8_t>(word & 0xFFU);
    word >>= 8;
  }
  add_bytes(bytes);
}

void Hash::add(std::int64_t word) {
  add(std::bit_cast<std::uint64_t>(word));
}

void Hash::add(float value) {
  poisoned_ = poisoned_ || value != value;
  add(value == 0.0F ? std::uint32_t{0} : std::bit_cast<std::uint32_t>(value));
}

void Hash::add(double value) {
  poisoned_ = poisoned_ || value != value;
  add(value == 0.0 ? std::uint64_t{0} : std::bit_cast<std::uint64_t>(value));
}

}  // namespace picolo::inline v0
