// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the faults of a wire cost a protocol, in figures.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "wires.hpp"

namespace picolo::test {

/// Of many cases of one fault, each with one of three packets damaged in a stream of 19.
struct Figures {
  std::size_t cases = 0;
  std::size_t worst_lost = 0;      ///< packets lost in one case, beyond those that were hit
  std::size_t following_lost = 0;  ///< cases in which a packet behind the damage was lost
  std::size_t false_accepts = 0;   ///< packets handed out that were never sent
  std::size_t worst_resync = 0;    ///< bytes behind the damaged packet until the next came out
};

struct Fault {
  const char* name;
  Figures (*measure)(const Wire& wire);
};
/// bit flip, byte lost, byte added, byte doubled, burst, torn off.
[[nodiscard]] const std::vector<Fault>& all_faults();

/// A megabyte of noise, then twenty packets behind 5000 bytes of it.
struct NoiseFigures {
  std::size_t believed = 0;
  double expected = 0.0;  ///< by the odds of header and checksum
  std::size_t found_behind = 0;
};
/// A terminal left in canonical mode swallows or changes control characters.
struct CanonicalFigures {
  std::size_t untouched = 0;  ///< of 60 packets; of capsules those whose successor is untouched too
  std::size_t found = 0;
  std::size_t wrong = 0;  ///< handed out, but never sent so
};
/// Two bits of forty are all that five-byte nodes protect: no driver can see the others flip.
[[nodiscard]] bool undetectable(const Wire& wire);

/// All of one protocol.
struct WireFigures {
  Wire wire;
  std::vector<Figures> faults{};  ///< in the order of all_faults
  NoiseFigures noise{};
  std::size_t believed_at_half = 0;  ///< of 190 packets, at half the rate
  std::size_t believed_at_double = 0;
  CanonicalFigures canonical{};
};
[[nodiscard]] WireFigures measure(const Wire& wire);

/// As Markdown.
[[nodiscard]] std::string to_table(const std::vector<WireFigures>& all);

}  // namespace picolo::test
