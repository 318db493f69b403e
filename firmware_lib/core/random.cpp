// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/random.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

Random::Random(std::uint64_t seed, std::uint64_t stream)
    : state_(0), increment_((stream << 1) | 1U) {
  static_cast<void>(next_u32());
  state_ += seed;
  static_cast<void>(next_u32());
}

std::uint32_t Random::next_u32() {
  const std::uint64_t old = state_;
  state_ = old * 6364136223846793005ULL + increment_;
  const auto shifted = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
  const auto rotation = static_cast<std::uint32_t>(old >> 59);
  return (shifted >> rotation) | (shifted << ((32U - rotation) & 31U));
}

std::uint32_t Random::below(std::uint32_t bound) {
  return static_cast<std::uint32_t>((static_cast<std::uint64_t>(next_u32()) * bound) >> 32);
}

float Random::uniform_f32() {
  return static_cast<float>(next_u32() >> 8) * 0x1p-24F;
}

double Random::uniform_f64() {
  const std::uint64_t high = next_u32() >> 5;
  const std::uint64_t low = next_u32() >> 6;
  return static_cast<double>((high << 26) | low) * 0x1p-53;
}

double Random::uniform(double low, double high) {
  return low + (high - low) * uniform_f64();
}

double Random::gaussian() {
  constexpr int kRounds = 32;  // each round fails with 0.21: all of them with 1e-22
  for (int round = 0; round < kRounds; ++round) {
    const double u = 2.0 * uniform_f64() - 1.0;
    const double v = 2.0 * uniform_f64() - 1.0;
    const double s = u * u + v * v;
    if (s > 0.0 && s < 1.0) { return u * square_root(-2.0 * logarithm(s) / s); }
  }
  return 0.0;
}

}  // namespace picolo::inline v0
