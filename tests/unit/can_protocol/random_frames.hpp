// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// 1000 frames of the table with random values, fifty a message, lowest and highest among them.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "picolo/controller/can_codec.hpp"

namespace picolo::test {

struct RandomFrame {
  const CanMessage* message = nullptr;
  CanValues values{};
  CanFrame frame{};
};

inline std::vector<RandomFrame> random_frames(std::uint16_t base_id) {
  std::mt19937_64 random{7};
  std::vector<RandomFrame> frames;
  for (std::size_t i = 0; i < 1000; ++i) {
    const std::size_t which = i % can_table::kMessages.size();
    RandomFrame one{.message = can_table::kMessages[which]};
    one.values.counter = static_cast<std::uint8_t>(random() % kCanCounterModulus);
    for (std::size_t k = 0; k < one.message->signals.size(); ++k) {
      const CanSignal& signal = one.message->signals[k];
      const std::uint64_t span = std::uint64_t{1} << signal.bits;
      const std::uint64_t extreme = random() % 16;
      const std::uint64_t drawn = random() % span;
      one.values.raw[k] = extreme == 0   ? signal.lowest()
                          : extreme == 1 ? signal.highest()
                                         : signal.lowest() + static_cast<std::int64_t>(drawn);
    }
    one.frame = encode(*one.message, base_id, one.values.counter, one.values.raw);
    frames.push_back(one);
  }
  return frames;
}

}  // namespace picolo::test
