// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One number for a whole trajectory or map: FNV-1a over canonical words.
#pragma once

#include <cstdint>
#include <span>

namespace picolo::inline v0 {

/// 64-bit FNV-1a. Floating-point values enter as canonical words: -0 as +0; a NaN sets
/// `poisoned()`.
/// Cost: O(bytes). Context: any.
class Hash {
 public:
  void add(std::uint32_t word);
  void add(std::uint64_t word);
  void add(std::int64_t word);
  void add(float value);
  void add(double value);
  void add_bytes(std::span<const std::uint8_t> bytes);
  [[nodiscard]] std::uint64_t value() const { return state_; }
  [[nodiscard]] bool poisoned() const { return poisoned_; }

 private:
  std::uint64_t state_ = 0xCBF29CE484222325ULL;
  bool poisoned_ = false;
};

}  // namespace picolo::inline v0
