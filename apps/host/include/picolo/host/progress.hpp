// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How far a command is, on standard error, and only when a person sits there.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

namespace picolo::host {

class Progress {
 public:
  /// Silent unless standard error is a terminal.
  Progress(std::string label, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Redraws at most ten times a second.
  void at(std::size_t done);

 private:
  std::string label_;
  std::size_t total_;
  bool shown_;
  std::chrono::steady_clock::time_point next_draw_{};
};

}  // namespace picolo::host
