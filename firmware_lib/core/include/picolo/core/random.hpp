// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Random numbers that are the same everywhere (the std distributions are not).
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// PCG32 (O'Neill 2014): 64-bit state, 32-bit output. The same seed gives the same numbers on every
/// platform.
/// Cost: O(1); `gaussian` about 4 rounds at worst 32. Context: one at a time.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 1);

  [[nodiscard]] std::uint32_t next_u32();
  /// In [0, bound), unbiased up to 2^-32; 0 for bound 0.
  [[nodiscard]] std::uint32_t below(std::uint32_t bound);
  /// In [0, 1).
  [[nodiscard]] float uniform_f32();
  [[nodiscard]] double uniform_f64();
  /// In [low, high).
  [[nodiscard]] double uniform(double low, double high);
  /// Standard normal (Marsaglia's polar method).
  [[nodiscard]] double gaussian();

 private:
  std::uint64_t state_;
  std::uint64_t increment_;
};

}  // namespace picolo::inline v0
