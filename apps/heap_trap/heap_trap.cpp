// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/heap_trap/heap_trap.hpp"

#include <cerrno>
#include <cstddef>

namespace picolo::heap_trap {
namespace {

// initial-exec: reading them never allocates, which the first access of other models may do.
[[gnu::tls_model("initial-exec")]] thread_local int depth = 0;
[[gnu::tls_model("initial-exec")]] thread_local std::uint64_t counted = 0;

void count() {
  if (depth > 0) { ++counted; }
}

}  // namespace

std::uint64_t calls() {
  return counted;
}
void enter() {
  ++depth;
}
void leave() {
  --depth;
}

}  // namespace picolo::heap_trap

#if defined(__SANITIZE_ADDRESS__)
#define PICOLO_TRAP_BY_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define PICOLO_TRAP_BY_SANITIZER 1
#endif
#endif

#ifdef PICOLO_TRAP_BY_SANITIZER

// Called by the sanitizer's allocator when defined by the program
// (sanitizer/allocator_interface.h).
extern "C" {
void __sanitizer_malloc_hook(const volatile void*, std::size_t);  // NOLINT
void __sanitizer_free_hook(const volatile void*);                 // NOLINT
void __sanitizer_malloc_hook(const volatile void* /*memory*/, std::size_t /*size*/) {
  picolo::heap_trap::count();
}
void __sanitizer_free_hook(const volatile void* memory) {
  if (memory != nullptr) { picolo::heap_trap::count(); }
}
}

#else

// glibc lets a program replace its allocator by defining these names; the originals stay reachable.
extern "C" {
void* __libc_malloc(std::size_t size);                           // NOLINT
void* __libc_calloc(std::size_t count, std::size_t size);        // NOLINT
void* __libc_realloc(void* memory, std::size_t size);            // NOLINT
void* __libc_memalign(std::size_t alignment, std::size_t size);  // NOLINT
void __libc_free(void* memory);                                  // NOLINT

void* malloc(std::size_t size) {
  picolo::heap_trap::count();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  picolo::heap_trap::count();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  picolo::heap_trap::count();
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  picolo::heap_trap::count();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  picolo::heap_trap::count();
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  picolo::heap_trap::count();
  *memory = __libc_memalign(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) {
  if (memory != nullptr) { picolo::heap_trap::count(); }
  __libc_free(memory);
}
}

#endif
