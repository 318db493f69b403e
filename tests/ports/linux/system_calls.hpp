// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counts what a piece of code asks of the kernel: work, where time depends on the machine.
#pragma once

#include <functional>
#include <optional>

namespace picolo::test {

/// Runs it in a child process and counts its system calls, but for the handful of starting and
/// ending. Nothing when this process may not trace.
[[nodiscard]] std::optional<int> system_calls_of(const std::function<void()>& work);

}  // namespace picolo::test
