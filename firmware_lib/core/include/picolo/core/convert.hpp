// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Float to integer, the only way the library does it: clamped, NaN to the low bound. The raw cast
/// differs between x86 and ARM outside of the integer's range and is undefined by the language.
#pragma once

#include <cstdint>

namespace picolo::inline v0 {

/// Nearest integer, halves away from zero, clamped to [low, high]; NaN gives `low`. Exact for every
/// `value`. Precondition of all: low <= high.
/// Cost: O(1).
/// Context: any.
[[nodiscard]] std::int32_t round_to_i32(float value, std::int32_t low, std::int32_t high);
[[nodiscard]] std::int64_t round_to_i64(double value, std::int64_t low, std::int64_t high);
/// Largest integer not above `value`, clamped to [low, high]; NaN gives `low`.
[[nodiscard]] std::int32_t floor_to_i32(float value, std::int32_t low, std::int32_t high);
[[nodiscard]] std::int32_t floor_to_i32(double value, std::int32_t low, std::int32_t high);

}  // namespace picolo::inline v0
