// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/devices/wrong_rate.hpp"

#include <cstddef>

namespace picolo::inline v0::devices {

std::vector<std::uint8_t> received_at(std::span<const std::uint8_t> sent, std::uint32_t sender_baud,
                                      std::uint32_t receiver_baud) {
  std::vector<bool> line(20, true);
  for (const std::uint8_t byte : sent) {
    line.push_back(false);
    for (unsigned bit = 0; bit < 8; ++bit) { line.push_back(((byte >> bit) & 1U) != 0); }
    line.push_back(true);
  }
  line.resize(line.size() + 40, true);
  const double step = static_cast<double>(sender_baud) / static_cast<double>(receiver_baud);
  std::vector<std::uint8_t> received;
  for (double at = 0.0; at + 10 * step < static_cast<double>(line.size());) {
    if (line[static_cast<std::size_t>(at)]) {
      at += 0.25;  // looks for the edge of a start bit
      continue;
    }
    unsigned byte = 0;
    for (int bit = 0; bit < 8; ++bit) {
      const auto sample = static_cast<std::size_t>(at + (1.5 + bit) * step);
      byte |= line[sample] ? 1U << bit : 0U;
    }
    received.push_back(static_cast<std::uint8_t>(byte));
    at += 9.5 * step;
  }
  return received;
}

}  // namespace picolo::inline v0::devices
