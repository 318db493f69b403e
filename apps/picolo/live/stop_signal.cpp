// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/stop_signal.hpp"

#include <csignal>

namespace picolo::tool {
namespace {

volatile std::sig_atomic_t stop_asked = 0;

void note(int /*signal*/) {
  stop_asked = 1;
}

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;  // without SA_RESTART, so that a sleep ends
  static_cast<void>(sigaction(SIGINT, &action, nullptr));
  static_cast<void>(sigaction(SIGTERM, &action, nullptr));
}

}  // namespace

StopSignal::StopSignal() {
  stop_asked = 0;
  handle(note);
  static_cast<void>(std::signal(SIGPIPE, SIG_IGN));
}

StopSignal::~StopSignal() {
  handle(SIG_DFL);
}

bool StopSignal::came() const {
  return stop_asked != 0;
}

}  // namespace picolo::tool
