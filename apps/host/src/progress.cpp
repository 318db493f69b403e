// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <utility>

namespace picolo::host {

Progress::Progress(std::string label, std::size_t total)
    : label_{std::move(label)}, total_{total}, shown_{::isatty(STDERR_FILENO) == 1} {}

Progress::~Progress() {
  if (shown_) { fmt::print(stderr, "\r\033[K"); }
}

void Progress::at(std::size_t done) {
  if (!shown_) { return; }
  const auto now = std::chrono::steady_clock::now();
  if (now < next_draw_) { return; }
  next_draw_ = now + std::chrono::milliseconds{100};
  const double share = total_ == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(total_);
  fmt::print(stderr, "\r\033[K{} {:.0f} % ({}/{})", label_, 100.0 * share, done, total_);
  std::fflush(stderr);
}

}  // namespace picolo::host
