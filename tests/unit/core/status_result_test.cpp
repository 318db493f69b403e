// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "picolo/core/result.hpp"
#include "picolo/core/status.hpp"

namespace picolo {
namespace {

constexpr int kStatusCount = static_cast<int>(Status::degenerate) + 1;

TEST(Status, EveryValueHasANameOfItsOwn) {
  std::set<std::string> names;
  for (int i = 0; i < kStatusCount; ++i) { names.insert(to_string(static_cast<Status>(i))); }
  EXPECT_EQ(names.size(), static_cast<std::size_t>(kStatusCount));
  EXPECT_FALSE(names.contains("unknown")) << "degenerate is no longer the last one, or has no name";
  EXPECT_STREQ(to_string(Status::ok), "ok");
  EXPECT_STREQ(to_string(Status::degenerate), "degenerate");
}

TEST(Status, AValueFromOutsideOfTheEnumerationIsUnknown) {
  EXPECT_STREQ(to_string(static_cast<Status>(kStatusCount)), "unknown");
  EXPECT_STREQ(to_string(static_cast<Status>(255)), "unknown");
}

TEST(Status, OnlyOkIsOk) {
  EXPECT_TRUE(is_ok(Status::ok));
  for (int i = 1; i < kStatusCount; ++i) { EXPECT_FALSE(is_ok(static_cast<Status>(i))); }
}

struct Sample {
  int a = 7;
  float b = 0.5F;
};

Result<Sample> half(int value) {
  if (value % 2 != 0) { return Status::invalid_argument; }
  return Sample{.a = value / 2};
}

TEST(Result, HoldsAValue) {
  const Result<Sample> result = half(8);
  ASSERT_TRUE(result);
  EXPECT_EQ(result.status(), Status::ok);
  EXPECT_EQ(result->a, 4);
  EXPECT_EQ((*result).b, 0.5F);
  EXPECT_EQ(result.value_or({.a = 1}).a, 4);
}

TEST(Result, HoldsAStatusAndThenADefaultValue) {
  const Result<Sample> result = half(3);
  EXPECT_FALSE(result);
  EXPECT_EQ(result.status(), Status::invalid_argument);
  EXPECT_EQ(result->a, 7);
  EXPECT_EQ(result.value_or({.a = 1}).a, 1);
}

TEST(Result, OkWithoutAValueIsTurnedIntoAnError) {
  const Result<int> result = Status::ok;
  EXPECT_FALSE(result);
  EXPECT_EQ(result.status(), Status::invalid_argument);
}

TEST(Result, WorksAtCompileTime) {
  constexpr Result<int> kGood = 3;
  constexpr Result<int> kBad = Status::full;
  static_assert(kGood && *kGood == 3 && !kBad && kBad.status() == Status::full);
  static_assert(kBad.value_or(9) == 9);
  EXPECT_EQ(kGood.value_or(1), 3);
}

}  // namespace
}  // namespace picolo
