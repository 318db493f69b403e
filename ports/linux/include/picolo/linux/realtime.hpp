// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What keeps the thread that runs the cycle on time. Each helps alone; `sleep_until` of
/// linux_clock.hpp belongs to them.
#pragma once

#include <cstddef>

#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// Keeps all memory of the process in RAM, now and later, and touches `stack_bytes` of this
/// thread's stack (at most 1 MiB), so that no page is fetched within the cycle. `io_error`: errno
/// says why; EPERM or ENOMEM: the limit `memlock` is too low (ulimit -l) and CAP_IPC_LOCK is
/// missing. Context: once, before the cycle.
Status lock_memory(std::size_t stack_bytes = 262'144);

/// Runs this thread before all ordinary ones: SCHED_FIFO, 1 (low) to 99. Above 50 it comes before
/// the kernel's interrupt threads. `invalid_argument`: no such priority. `io_error`: errno says
/// why; EPERM: the limit `rtprio` is too low (ulimit -r) and CAP_SYS_NICE is missing.
Status use_fifo_priority(int priority);

/// Lets this thread's timers be exact; ordinary threads are woken up to 50 us late on purpose.
/// Needs no rights. `io_error`: errno says why.
Status use_exact_timers();

}  // namespace picolo::inline v0
