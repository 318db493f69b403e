// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The k-th smallest of a sequence that is only read again and again: no value is kept.
#pragma once

#include <array>
#include <cstdint>

namespace picolo::inline v0 {

/// Sections of the bit patterns of non-negative doubles, which are ordered like the values
/// themselves: each pass over all values narrows the answer by four bits, so 16 passes give it
/// exactly. State: 160 bytes. Cost: O(1) a value. Context: one at a time. Use: select(k); while
/// (searching()) { for every value: offer(value); end_pass(); } value().
class OrderStatistic {
 public:
  /// Starts the search of the value at `index` (0 is the smallest) of the sorted sequence.
  void select(std::uint64_t index);
  [[nodiscard]] bool searching() const { return bits_left_ > 0; }
  /// Negative values and NaN count as 0.
  void offer(double value);
  void end_pass();
  /// Precondition: not searching(). Infinity when the sequence has no such index.
  [[nodiscard]] double value() const;

 private:
  std::uint64_t prefix_ = 0;
  std::uint64_t index_ = 0;
  int bits_left_ = 0;
  bool beyond_ = false;
  std::array<std::uint64_t, 16> counts_{};
};

}  // namespace picolo::inline v0
