// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The six-bit text of SCIP 2.0: sums and numbers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"

namespace picolo::inline v0 {

/// The character that closes a line: low six bits of the sum, plus 0x30.
[[nodiscard]] std::uint8_t scip_sum(ByteView text);
/// Six bits a character, most significant first. Precondition: text.size() <= 4.
[[nodiscard]] constexpr std::uint32_t scip_number(ByteView text) {
  std::uint32_t value = 0;
  for (const std::uint8_t c : text) { value = (value << 6U) | ((c - 0x30U) & 0x3FU); }
  return value;
}
/// Decimal digits only. `corrupt`: anything else, or none.
[[nodiscard]] Result<std::uint32_t> scip_decimal(ByteView text);

static_assert(scip_number(std::span<const std::uint8_t>{}) == 0);

/// What a measuring command asks for; the device repeats it in front of every scan.
struct ScipCommand {
  bool continuous = false;      ///< M: many scans; G: one
  std::uint8_t value_size = 3;  ///< S 2, D 3, E 6 characters (range and intensity)
  std::uint16_t first_step = 0;
  std::uint16_t last_step = 0;
  std::uint8_t cluster = 1;  ///< steps a value stands for

  [[nodiscard]] constexpr std::size_t values() const {
    return (static_cast<std::size_t>(last_step) - first_step) / cluster + 1;
  }
  [[nodiscard]] constexpr std::size_t characters() const { return values() * value_size; }
  friend constexpr bool operator==(const ScipCommand&, const ScipCommand&) = default;
};

/// The line feed in front of the echo may be lost: what stands before it is skipped. `corrupt`: not
/// the echo of a measuring command, or steps that cannot be.
[[nodiscard]] Result<ScipCommand> parse_scip_echo(ByteView line);

/// Angles and limits of a model, from its answer to PP.
struct ScipModel {
  std::uint32_t steps_per_turn = 1440;  ///< ARES
  std::uint32_t first_step = 0;         ///< AMIN
  std::uint32_t last_step = 1080;       ///< AMAX
  std::uint32_t front_step = 540;       ///< AFRT, on the x axis
  std::uint32_t min_mm = 23;            ///< DMIN; smaller values are error codes
  std::uint32_t max_mm = 60'000;        ///< DMAX
  std::uint32_t turns_per_minute = 2400;
  [[nodiscard]] constexpr bool valid() const {
    return steps_per_turn >= 4 && steps_per_turn <= 100'000 && first_step <= last_step &&
           last_step <= 9999 && front_step <= 9999 && min_mm < max_mm && turns_per_minute > 0 &&
           turns_per_minute <= 60'000;
  }
};

/// A status, or a line of an answer in words, with the right sum.
[[nodiscard]] bool is_scip_answer(ByteView line);
/// Takes one line of an answer to PP ("ARES:1024;" and sum); false when it is none, or when its
/// sum or its number is wrong.
bool read_scip_parameter(ByteView line, ScipModel& model);

}  // namespace picolo::inline v0
