// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/live_loop.hpp"

#include <fmt/format.h>

#include "picolo/core/status.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {

void LiveLoop::start(Timestamp now) {
  journal_ = DriveJournal{now};
  clock_.latch(now);
  if (recorder_ != nullptr) { recorder_->start(now); }
  const Status status = vehicle_.start();
  if (status == Status::ok) { return; }
  throw host::UserError{host::ExitCode::refused, "",
                        fmt::format("the controller does not start: {}", to_string(status)),
                        "check the configuration file"};
}

bool LiveLoop::cycle(Timestamp now) {
  clock_.latch(now);
  if (recorder_ != nullptr) { recorder_->begin_cycle(now); }
  static_cast<void>(vehicle_.run_frame());  // not due yet: nothing to do
  if (recorder_ != nullptr) { recorder_->end_cycle(); }
  return journal_.add(vehicle_.estimate(), now);
}

void LiveLoop::finish() {
  if (recorder_ != nullptr) { recorder_->finish(journal_); }
}

}  // namespace picolo::tool
