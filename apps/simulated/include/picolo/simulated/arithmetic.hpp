// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The processor's arithmetic, or its compiler's library, in one number.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// Hash over + - * / square root and conversions, float and double, of random operands whose
/// exponents are often near one another.
[[nodiscard]] std::uint64_t hash_of_arithmetic();

}  // namespace picolo::inline v0
