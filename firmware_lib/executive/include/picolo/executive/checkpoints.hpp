// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Did everything happen that had to, and in order? The question behind each stroke of the
/// watchdog.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// Checkpoints of one round carry strictly increasing keys. A round is complete when as many were
/// passed as expected, none twice and none out of order. Cost: O(1). Context: cycle only.
class CheckpointMonitor {
 public:
  /// Starts a round in which `expected` checkpoints have to be passed.
  void begin(std::uint32_t expected);
  /// Key at most 2^32 - 2. A key not above its predecessor spoils the round.
  void pass(std::uint32_t key);
  /// The round cannot become complete any more.
  void spoil() { spoilt_ = true; }
  [[nodiscard]] bool complete() const { return !spoilt_ && passed_ == expected_; }

 private:
  std::uint32_t expected_ = 0;
  std::uint32_t passed_ = 0;
  std::uint32_t next_key_ = 0;  // the least that is in order
  bool spoilt_ = true;          // until the first round begins
};

}  // namespace picolo::inline v0
