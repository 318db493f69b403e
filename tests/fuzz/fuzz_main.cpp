// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// One program for all targets; PICOLO_FUZZ_TARGET names the one that runs.
#include <sanitizer/allocator_interface.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "targets.hpp"

namespace picolo::fuzz {
namespace {

const Target* g_target = nullptr;
// Of the thread that fuzzes: another of the fuzzer's own may begin meanwhile, and allocates.
thread_local bool g_trap = false;

void on_malloc(const volatile void* /*pointer*/, std::size_t /*size*/) {
  if (!g_trap) { return; }
  g_trap = false;
  fail("heap used in firmware code");
}
void on_free(const volatile void* /*pointer*/) {}

const Target* find(const char* name) {
  static std::vector<Target> targets;
  for (const auto& group : {serial_targets(), can_targets(), slcan_targets(), text_targets(),
                            store_targets(), algorithm_targets()}) {
    targets.insert(targets.end(), group.begin(), group.end());
  }
  for (const Target& target : targets) {
    if (name != nullptr && std::strcmp(target.name, name) == 0) { return &target; }
  }
  std::fprintf(stderr, "set PICOLO_FUZZ_TARGET to one of:");
  for (const Target& target : targets) { std::fprintf(stderr, " %s", target.name); }
  std::fprintf(stderr, "\n");
  std::exit(2);
}

}  // namespace

void fail(const char* what) {
  g_trap = false;
  std::fprintf(stderr, "picolo fuzz: %s\n", what);
  __builtin_trap();
}

}  // namespace picolo::fuzz

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  using namespace picolo::fuzz;
  g_target = find(std::getenv("PICOLO_FUZZ_TARGET"));
  __sanitizer_install_malloc_and_free_hooks(on_malloc, on_free);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace picolo::fuzz;
  g_trap = g_target->no_heap;
  g_target->run({data, size});
  g_trap = false;
  return 0;
}
