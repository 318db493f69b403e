// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What leaves an interrupt: nothing lost but what is counted, nothing torn, nothing out of order.

#include "picolo/core/ring_buffer.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace picolo {
namespace {

TEST(SpscRing, KeepsTheOrderAndRefusesTheNewestWhenFull) {
  SpscRing<int, 4> ring;
  int value = -1;
  EXPECT_FALSE(ring.pop(value));
  EXPECT_EQ(value, -1);
  for (int i = 0; i < 4; ++i) { EXPECT_TRUE(ring.push(i)); }
  EXPECT_EQ(ring.size(), 4U);
  EXPECT_FALSE(ring.push(4));
  EXPECT_FALSE(ring.push(5));
  EXPECT_EQ(ring.dropped(), 2U);
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(ring.pop(value));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(ring.pop(value));
  EXPECT_TRUE(ring.push(6));
  EXPECT_EQ(ring.dropped(), 2U);
}

TEST(SpscRing, RunsRoundManyTimes) {
  SpscRing<int, 8> ring;
  int next = 0;
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(ring.push(i));
    if (i % 3 != 0) { continue; }
    int value = 0;
    while (ring.pop(value)) {
      ASSERT_EQ(value, next);
      ++next;
    }
  }
  static_assert(SpscRing<int, 8>::capacity() == 8);
}

/// Wide enough to be torn when written and read at once: all parts carry the same number.
template <std::size_t Parts>
struct Filled {
  std::array<std::uint32_t, Parts> parts{};

  static Filled of(std::uint32_t number) {
    Filled wide;
    wide.parts.fill(number);
    return wide;
  }
  [[nodiscard]] bool whole() const {
    for (const std::uint32_t part : parts) {
      if (part != parts[0]) { return false; }
    }
    return true;
  }
};

using Wide = Filled<15>;

TEST(SpscRing, TwoThreadsExchangeEverythingWholeAndInOrder) {
  constexpr std::uint32_t kCount = 100000;
  SpscRing<Wide, 16> ring;
  std::thread producer{[&ring] {
    for (std::uint32_t i = 1; i <= kCount;) {
      if (ring.push(Wide::of(i))) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  }};
  std::uint32_t expected = 1;
  bool whole = true;
  bool in_order = true;
  while (expected <= kCount) {
    Wide value;
    if (!ring.pop(value)) {
      std::this_thread::yield();
      continue;
    }
    whole = whole && value.whole();
    in_order = in_order && value.parts[0] == expected;
    ++expected;
  }
  producer.join();
  EXPECT_TRUE(whole);
  EXPECT_TRUE(in_order);
  EXPECT_EQ(ring.size(), 0U);
}

TEST(SpscRing, WhatIsRefusedIsCountedAcrossThreads) {
  constexpr std::uint32_t kCount = 20000;
  SpscRing<std::uint32_t, 4> ring;
  std::uint32_t accepted = 0;
  std::thread producer{[&] {
    for (std::uint32_t i = 0; i < kCount; ++i) { accepted += ring.push(i) ? 1U : 0U; }
  }};
  std::uint32_t received = 0;
  std::uint32_t value = 0;
  std::uint32_t last = 0;
  bool rising = true;
  const auto drain = [&] {
    while (ring.pop(value)) {
      rising = rising && (received == 0 || value > last);
      last = value;
      ++received;
    }
  };
  for (int i = 0; i < 1000; ++i) { drain(); }
  producer.join();
  drain();
  EXPECT_TRUE(rising);
  EXPECT_EQ(received, accepted);
  EXPECT_EQ(ring.dropped(), kCount - accepted);
}

TEST(LatestValue, IsEmptyUntilTheFirstPublication) {
  LatestValue<Wide> latest;
  Wide value = Wide::of(9);
  EXPECT_FALSE(latest.read(value));
  EXPECT_EQ(value.parts[0], 9U);
  EXPECT_EQ(latest.sequence(), 0U);
  latest.publish(Wide::of(1));
  ASSERT_TRUE(latest.read(value));
  EXPECT_EQ(value.parts[0], 1U);
  EXPECT_EQ(latest.sequence(), 1U);
}

TEST(LatestValue, GivesTheNewestAsOftenAsAsked) {
  LatestValue<std::uint64_t> latest;
  for (std::uint64_t i = 1; i <= 10; ++i) {
    latest.publish(i << 33);
    std::uint64_t value = 0;
    ASSERT_TRUE(latest.read(value));
    EXPECT_EQ(value, i << 33);
    ASSERT_TRUE(latest.read(value));
    EXPECT_EQ(value, i << 33);
  }
}

TEST(LatestValue, HoldsTypesThatAreNoMultipleOfAWord) {
  struct Odd {
    std::array<std::uint8_t, 7> bytes{};
  };
  LatestValue<Odd> latest;
  latest.publish({{1, 2, 3, 4, 5, 6, 7}});
  Odd odd;
  ASSERT_TRUE(latest.read(odd));
  EXPECT_EQ(odd.bytes[6], 7);
}

TEST(LatestValue, StaysReadableWhenTheSequenceWraps) {
  LatestValue<int, 0xFFFFFFFD> latest;
  int value = 0;
  EXPECT_FALSE(latest.read(value));
  for (int i = 1; i <= 8; ++i) {
    latest.publish(i);
    ASSERT_TRUE(latest.read(value)) << "sequence " << latest.sequence();
    EXPECT_EQ(value, i);
  }
  EXPECT_EQ(latest.sequence(), 5U);
}

struct Seen {
  std::uint32_t reads = 0;
  bool whole = true;
  bool rising = true;
};

TEST(LatestValue, RacingReadersSeeWholeValuesThatNeverGoBack) {
  // Long values and more readers than processors: many are interrupted in the middle of a copy.
  using Long = Filled<600>;
  constexpr std::uint32_t kCount = 20000;
  constexpr std::size_t kReaders = 4;
  const auto latest = std::make_unique<LatestValue<Long>>();
  latest->publish(Long::of(1));
  std::array<Seen, kReaders> seen{};
  std::vector<std::thread> readers;
  for (Seen& own : seen) {
    readers.emplace_back([&latest, &own] {
      std::uint32_t newest = 0;
      while (newest < kCount) {
        Long value;
        if (!latest->read(value)) { continue; }
        own.whole = own.whole && value.whole();
        own.rising = own.rising && value.parts[0] >= newest;
        newest = value.parts[0];
        ++own.reads;
      }
    });
  }
  for (std::uint32_t i = 2; i <= kCount; ++i) { latest->publish(Long::of(i)); }
  for (std::thread& reader : readers) { reader.join(); }
  for (const Seen& own : seen) {
    EXPECT_TRUE(own.whole);
    EXPECT_TRUE(own.rising);
    EXPECT_GT(own.reads, 0U);
  }
}

}  // namespace
}  // namespace picolo
