// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every rapidcheck test includes: a fixed seed, unless RC_PARAMS names another one, and
/// generators of finite numbers (rapidcheck has none for intervals of floats).
#pragma once

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cstdint>
#include <cstdlib>

namespace picolo::test {

// Before main: rapidcheck reads the variable at its first use.
inline const int kSeedIsFixed = setenv("RC_PARAMS", "seed=20110811", /*overwrite=*/0);

/// Uniform on a grid of 2^32 steps over [low, high]; shrinks towards low.
inline rc::Gen<double> number(double low, double high) {
  return rc::gen::map(rc::gen::arbitrary<std::uint32_t>(), [low, high](std::uint32_t step) {
    return low + (high - low) * (static_cast<double>(step) / 4294967295.0);
  });
}

}  // namespace picolo::test
