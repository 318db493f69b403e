// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/fixed_vector.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace picolo {
namespace {

constinit FixedVector<int, 4> g_static_storage{};

TEST(FixedVector, FillsUpToItsCapacityAndThenRefuses) {
  FixedVector<int, 3> items;
  EXPECT_TRUE(items.empty());
  EXPECT_TRUE(items.push_back(1));
  EXPECT_TRUE(items.push_back(2));
  EXPECT_FALSE(items.full());
  EXPECT_TRUE(items.push_back(3));
  EXPECT_TRUE(items.full());

  EXPECT_FALSE(items.push_back(4));
  EXPECT_EQ(items.size(), 3U);
  EXPECT_EQ(items[2], 3);
}

TEST(FixedVector, ClearMakesRoomAgain) {
  FixedVector<int, 2> items;
  EXPECT_TRUE(items.push_back(1));
  EXPECT_TRUE(items.push_back(2));
  items.clear();
  EXPECT_TRUE(items.empty());
  EXPECT_TRUE(items.push_back(5));
  EXPECT_EQ(items[0], 5);
  EXPECT_EQ(items.size(), 1U);
}

TEST(FixedVector, ResizeShrinksAndGrowsOverWhatWasThere) {
  FixedVector<int, 4> items;
  EXPECT_TRUE(items.resize(4));
  EXPECT_EQ(items[3], 0);
  items[3] = 9;
  EXPECT_TRUE(items.resize(1));
  EXPECT_EQ(items.size(), 1U);
  EXPECT_TRUE(items.resize(4));
  EXPECT_EQ(items[3], 9);
  EXPECT_FALSE(items.resize(5));
  EXPECT_EQ(items.size(), 4U);
}

TEST(FixedVector, ViewsAndIterationCoverTheFilledPart) {
  FixedVector<int, 8> items;
  for (int i = 1; i <= 5; ++i) { EXPECT_TRUE(items.push_back(i)); }
  EXPECT_EQ(std::accumulate(items.begin(), items.end(), 0), 15);
  EXPECT_EQ(items.view().size(), 5U);
  for (int& item : items.view()) { item *= 2; }
  const FixedVector<int, 8>& constant = items;
  EXPECT_EQ(constant.view().back(), 10);
  EXPECT_EQ(constant[0], 2);
}

TEST(FixedVector, CopiesAreIndependent) {
  FixedVector<int, 2> a;
  EXPECT_TRUE(a.push_back(1));
  FixedVector<int, 2> b = a;
  b[0] = 2;
  EXPECT_EQ(a[0], 1);
  static_assert(std::is_trivially_copyable_v<FixedVector<int, 2>>);
}

TEST(FixedVector, LivesInStaticStorageWithoutStartUpCode) {
  EXPECT_TRUE(g_static_storage.empty());
  static_assert(FixedVector<int, 4>::capacity() == 4);
  constexpr auto kFilled = [] {
    FixedVector<int, 2> items;
    static_cast<void>(items.push_back(3));
    return items;
  }();
  static_assert(kFilled.size() == 1 && kFilled[0] == 3);
}

}  // namespace
}  // namespace picolo
