// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/diagnostics.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace picolo::host {

Diagnostics::Diagnostics()
    : Diagnostics([](std::string_view line) { fmt::print(stderr, "picolo: {}\n", line); }) {}

Diagnostics::Diagnostics(Sink sink) : sink_(std::move(sink)) {}

void Diagnostics::warn(const std::string& file, const std::string& cause, const std::string& cure) {
  sink_(fmt::format("warning: {}{}{}{}{}", file, file.empty() ? "" : ": ", cause,
                    cure.empty() ? "" : "; ", cure));
}

void Diagnostics::skipped_line(const std::string& file, std::size_t line,
                               const std::string& cause) {
  ++skipped_;
  ++skipped_in_file_;
  if (skipped_in_file_ <= kShown) {
    sink_(fmt::format("warning: {}:{}: {}; line skipped", file, line, cause));
  }
}

void Diagnostics::end_of_file(const std::string& file) {
  if (skipped_in_file_ > kShown) {
    sink_(fmt::format("warning: {}: {} more bad lines skipped ({} in all); is this the right file?",
                      file, skipped_in_file_ - kShown, skipped_in_file_));
  }
  skipped_in_file_ = 0;
}

}  // namespace picolo::host
