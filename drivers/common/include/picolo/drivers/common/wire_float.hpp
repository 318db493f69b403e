// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Numbers of the wires as float, without a double anywhere and without trusting the wire.
#pragma once

#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"

namespace picolo::inline v0 {

/// `corrupt` for NaN and infinity, which no sensor measures.
[[nodiscard]] Result<float> float_from_bits(std::uint32_t bits);
/// IEEE 754 binary64 to the nearest float; what is too small becomes 0, what is too large
/// `corrupt`, as NaN and infinity.
[[nodiscard]] Result<float> float_from_f64_bits(std::uint64_t bits);
/// value / 2^fraction_bits. Precondition: fraction_bits <= 62.
[[nodiscard]] float float_from_fixed(std::int64_t value, unsigned fraction_bits);
/// Decimal text as sensors write it: sign, digits, point, digits; up to 9 digits count.
/// `corrupt`: anything else, or no digit.
[[nodiscard]] Result<float> float_from_text(ByteView text);
/// A float from the wire times a whole number, rounded to the nearest integer, halves away from
/// zero: exact, so that a position in revolutions loses nothing on its way to counts. `corrupt`:
/// NaN, infinity, or beyond 2^62.
[[nodiscard]] Result<std::int64_t> scaled_integer(std::uint32_t float_bits, std::uint32_t scale);

}  // namespace picolo::inline v0
