// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One scan of a SCIP 2.0 device, collected line by line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/drivers/scip/scip_text.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kScipMaxValues = 1600;
inline constexpr std::size_t kScipLineLength = 64;  ///< characters of data, before the sum

/// Lines carry no number, so each is placed by its distance from the echo: a line that lost or
/// gained a byte costs its own values only. A scan that misses more than that is refused as a
/// whole, since values would stand at wrong angles.
/// Cost: O(line). Memory: 3.3 KB. Context: one at a time.
class ScipScan {
 public:
  /// A scan begins behind an echo. False when it is too long for the memory.
  bool begin(const ScipCommand& command);
  /// A line that began `offset` bytes after the echo's line feed. False: its sum or its length is
  /// wrong, or it is no line of this scan.
  bool line(std::size_t offset, ByteView text);
  /// Whether such a line would be whole: its line feed may be missing.
  [[nodiscard]] bool is_whole(std::size_t offset, ByteView text) const;
  /// Nothing of it can follow.
  [[nodiscard]] bool has_last_line() const { return next_line_ == lines(); }
  /// The empty line that closes a scan may stand here.
  [[nodiscard]] bool may_end_at(std::size_t offset) const;
  /// After the last line. True: the values are where they belong. `offset`: of the line that was
  /// no data any more.
  [[nodiscard]] bool complete(std::size_t offset) const;

  [[nodiscard]] const ScipCommand& command() const { return command_; }
  /// Millimetres; 0 = lost with its line.
  [[nodiscard]] std::uint32_t value(std::size_t index) const { return values_[index]; }
  /// 24 bits of milliseconds.
  [[nodiscard]] std::uint32_t time_ms() const { return time_ms_; }
  [[nodiscard]] bool has_time() const { return has_time_; }
  [[nodiscard]] std::size_t good_lines() const { return good_lines_; }
  [[nodiscard]] std::size_t lines() const {
    return (command_.characters() + kScipLineLength - 1) / kScipLineLength;
  }

 private:
  [[nodiscard]] std::size_t line_length(std::size_t index) const;
  void read_values(std::size_t index, ByteView text);
  void take(std::size_t position, std::uint8_t character);

  ScipCommand command_{};
  std::array<std::uint16_t, kScipMaxValues> values_{};
  std::uint32_t time_ms_ = 0;
  bool has_time_ = false;
  std::uint32_t partial_ = 0;      ///< characters of a value that straddles two lines
  std::size_t next_position_ = 0;  ///< of the character that would continue it
  std::size_t next_line_ = 0;
  std::size_t good_lines_ = 0;
};

}  // namespace picolo::inline v0
