// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Ctrl-C and kill end a command in good order.
#pragma once

namespace picolo::tool {

/// From construction on SIGINT and SIGTERM are only noted, and wake a sleep. One at a time.
class StopSignal {
 public:
  StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;
  ~StopSignal();

  [[nodiscard]] bool came() const;
};

}  // namespace picolo::tool
