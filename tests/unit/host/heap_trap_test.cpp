// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/heap_trap/heap_trap.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace picolo {
namespace {

/// Keeps the compiler from leaving out allocations whose memory nobody looks at.
void look_at(const void* memory) {
  asm volatile("" : : "g"(memory) : "memory");  // NOLINT(hicpp-no-assembler)
}

template <typename Action>
std::uint64_t calls_of(Action action) {
  const std::uint64_t before = heap_trap::calls();
  {
    const heap_trap::Guard guard;
    action();
  }
  return heap_trap::calls() - before;
}

TEST(HeapTrap, FiresOnEveryWayToTheHeap) {
  EXPECT_GE(calls_of([] { look_at(std::make_unique<int>(1).get()); }), 2U) << "new and delete";
  EXPECT_GE(calls_of([] { look_at(std::vector<double>(1000).data()); }), 2U);
  EXPECT_GE(calls_of([] {
              void* memory = std::calloc(16, 1);
              look_at(memory);
              memory = std::realloc(memory, 4096);
              look_at(memory);
              std::free(memory);
            }),
            3U);
  EXPECT_GE(calls_of([] {
              void* memory = std::calloc(4, 4);
              look_at(memory);
              std::free(memory);
            }),
            2U);
  EXPECT_GE(calls_of([] {
              void* memory = std::aligned_alloc(64, 128);
              look_at(memory);
              std::free(memory);
            }),
            2U);
  struct alignas(64) Wide {
    char bytes[64];
  };
  EXPECT_GE(calls_of([] { look_at(std::make_unique<Wide>().get()); }), 2U) << "aligned new";
}

TEST(HeapTrap, FiresInsideOfSharedLibraries) {
  EXPECT_GE(calls_of([] { look_at(std::string(500, 'x').substr(1).data()); }), 2U);
  EXPECT_GE(calls_of([] { look_at(std::to_string(1.5e300).data()); }), 2U);
}

TEST(HeapTrap, IsSilentOutsideOfTheRegionAndWithoutHeapCalls) {
  const std::uint64_t before = heap_trap::calls();
  look_at(std::make_unique<int>(1).get());
  EXPECT_EQ(heap_trap::calls(), before);
  EXPECT_EQ(calls_of([] {
              double sum = 0.0;
              for (int i = 0; i < 100; ++i) { sum += i; }
              look_at(&sum);
              std::free(nullptr);
            }),
            0U);
}

TEST(HeapTrap, RegionsNest) {
  heap_trap::enter();
  { const heap_trap::Guard inner; }
  const std::uint64_t before = heap_trap::calls();
  look_at(std::make_unique<int>(1).get());
  const std::uint64_t counted = heap_trap::calls() - before;
  heap_trap::leave();
  EXPECT_GE(counted, 2U) << "leaving the inner region does not leave the outer";
}

TEST(HeapTrap, ThreadsCountForThemselves) {
  const std::uint64_t own = calls_of([] {});
  std::uint64_t of_other = 0;
  std::thread other{
      [&of_other] { of_other = calls_of([] { look_at(std::make_unique<int>(1).get()); }); }};
  other.join();
  EXPECT_EQ(own, 0U);
  EXPECT_GE(of_other, 2U);
}

}  // namespace
}  // namespace picolo
