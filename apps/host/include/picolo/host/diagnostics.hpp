// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Warnings for people: standard error by default, at most a few dozen a file, then a count.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace picolo::host {

class Diagnostics {
 public:
  using Sink = std::function<void(std::string_view line)>;

  /// Writes "picolo: warning: ..." lines to standard error.
  Diagnostics();
  explicit Diagnostics(Sink sink);

  /// "FILE: cause; cure".
  void warn(const std::string& file, const std::string& cause, const std::string& cure = {});
  /// "FILE:LINE: cause; skipped". From `kShown` on they are only counted.
  void skipped_line(const std::string& file, std::size_t line, const std::string& cause);
  /// Says how many skipped lines were not shown; call once after the last line of a file.
  void end_of_file(const std::string& file);

  [[nodiscard]] std::size_t skipped() const { return skipped_; }

  static constexpr std::size_t kShown = 50;

 private:
  Sink sink_;
  std::size_t skipped_ = 0;
  std::size_t skipped_in_file_ = 0;
};

}  // namespace picolo::host
