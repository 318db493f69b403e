// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/simulated/arithmetic.hpp"

#include <bit>

#include "picolo/core/hash.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/core/random.hpp"

namespace picolo::inline v0 {
namespace {

constexpr int kOperands = 20'000;

/// NaN has many words; which one comes out is the processor's choice.
template <typename T>
void add(Hash& hash, T value) {
  hash.add(value == value ? value : T(-12345));
}

template <typename T>
void compute(Hash& hash, T a, T b) {
  add(hash, a + b);
  add(hash, a - b);
  add(hash, a * b);
  add(hash, a / b);
  add(hash, square_root(a));
  hash.add(static_cast<std::uint32_t>((a < b ? 1 : 0) + (a <= b ? 2 : 0) + (a == b ? 4 : 0)));
}

}  // namespace

std::uint64_t hash_of_arithmetic() {
  Random random{17};
  Hash hash;
  for (int i = 0; i < kOperands; ++i) {
    const std::uint64_t high = random.next_u32();
    const std::uint64_t a = (high << 32) | random.next_u32();
    const std::uint64_t other = random.next_u32();
    std::uint64_t b = (other << 32) | random.next_u32();
    if (random.below(4) != 0) {
      const std::uint64_t exponent = ((a >> 52) & 0x7FFU) + random.below(140) - 70U;
      b = (b & 0x800FFFFFFFFFFFFFULL) | ((exponent & 0x7FFU) << 52);
    }
    compute(hash, std::bit_cast<double>(a), std::bit_cast<double>(b));
    auto c = static_cast<std::uint32_t>(a >> 32);
    auto d = static_cast<std::uint32_t>(b >> 32);
    compute(hash, std::bit_cast<float>(c), std::bit_cast<float>(d));
    add(hash, static_cast<float>(std::bit_cast<double>(a)));
    add(hash, static_cast<double>(std::bit_cast<float>(c)));
    add(hash, static_cast<double>(std::bit_cast<std::int64_t>(a >> (i % 64))));
    add(hash, static_cast<float>(std::bit_cast<std::int64_t>(b >> (i % 64))));
    add(hash, static_cast<double>(c));
    add(hash, static_cast<float>(d));
  }
  return hash.value();
}

}  // namespace picolo::inline v0
