// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Commands of the machine under test.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

namespace picolo::test {

/// Runs a command; a command that fails is a failure of the test.
inline void shell(const std::string& command) {
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
}

}  // namespace picolo::test
