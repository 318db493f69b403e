// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs the conformance checks of hal under Google Test: each violated contract is one failure.
#pragma once

#include <gtest/gtest.h>

#include "picolo/hal/conformance/checker.hpp"

namespace picolo::test {

/// A checker whose reports fail the running test.
inline conformance::Checker failing_checker() {
  return conformance::Checker{[](void*, const char* contract, const char* cure) {
    ADD_FAILURE() << "contract violated: " << contract << "\n  cure: " << cure;
  }};
}

/// Runs `check` and insists that it checked something.
template <typename Harness, typename Check>
void expect_conformance(Harness& harness, Check check, std::uint32_t at_least) {
  conformance::Checker checker = failing_checker();
  check(harness, checker);
  EXPECT_GE(checker.checked(), at_least) << "the suite stopped early";
}

}  // namespace picolo::test
