// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counts heap calls of guarded code, for `heap_calls` in reports and for the tests that prove it
/// 0. An executable that links picolo_heap_trap has malloc, calloc, realloc, free and their aligned
/// forms replaced by counting ones; operator new and delete end there too, also those called inside
/// of shared libraries. Under AddressSanitizer its own hooks count instead.
#pragma once

#include <cstdint>

namespace picolo::heap_trap {

/// Heap calls (allocations and releases) of this thread inside of guarded regions since start.
/// Context: any thread, each has its own count.
[[nodiscard]] std::uint64_t calls();

/// Opens and closes a guarded region of this thread; regions nest.
void enter();
void leave();

/// A guarded region as a scope.
class Guard {
 public:
  Guard() { enter(); }
  ~Guard() { leave(); }
  Guard(const Guard&) = delete;
  Guard& operator=(const Guard&) = delete;
};

}  // namespace picolo::heap_trap
