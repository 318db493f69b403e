// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Every serial protocol behind one face: numbered packets in, the numbers of those that were
/// accepted out.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "support/bytes.hpp"

namespace picolo::test {

/// What one decoder made of a stream: for every packet its number and the bytes read until then.
struct Accepted {
  std::uint32_t number = 0;
  std::size_t at = 0;   ///< bytes read when it was handed out
  bool intact = false;  ///< its content is what packet `number` holds
};

struct Wire {
  std::string name;
  std::function<Bytes(std::uint32_t number)> packet;
  /// Feeds a stream to a new decoder.
  std::function<std::vector<Accepted>(const Bytes& stream)> read;
  double checksum_bits = 8;     ///< odds of a false accept: 2^-bits a candidate
  std::size_t lag = 0;          ///< bytes behind a packet that its decoder waits for
  std::uint32_t numbers = 200;  ///< packets are numbered modulo this
};

[[nodiscard]] std::vector<Wire> all_wires();
/// Those of them that are RPLIDAR capsules.
[[nodiscard]] std::vector<Wire> capsule_wires();

}  // namespace picolo::test
