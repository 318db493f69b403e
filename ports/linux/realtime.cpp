// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/linux/realtime.hpp"

#include <alloca.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cerrno>

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kPageBytes = 4096;
constexpr std::size_t kMaxStackBytes = 1'048'576;

[[gnu::noinline]] void touch_stack(std::size_t bytes) {
  auto* stack = static_cast<volatile unsigned char*>(alloca(bytes));
  for (std::size_t i = 0; i < bytes; i += kPageBytes) { stack[i] = 0; }
}

}  // namespace

Status lock_memory(std::size_t stack_bytes) {
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) != 0) { return Status::io_error; }
  touch_stack(std::clamp(stack_bytes, kPageBytes, kMaxStackBytes));
  return Status::ok;
}

Status use_fifo_priority(int priority) {
  if (priority < 1 || priority > 99) { return Status::invalid_argument; }
  sched_param parameters{};
  parameters.sched_priority = priority;
  errno = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters);
  return errno == 0 ? Status::ok : Status::io_error;
}

Status use_exact_timers() {
  return ::prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL) == 0 ? Status::ok : Status::io_error;
}

}  // namespace picolo::inline v0
