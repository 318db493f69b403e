// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/feature_index.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo {
namespace {

constexpr std::size_t kRings = 8;

struct Index {
  std::array<std::uint16_t, kRings * 30 + 1> starts{};
  std::array<std::uint16_t, 1000> order{};
  FeatureIndex index{starts, order, kRings};
};

Vector3f random_point(Random& random) {
  const auto x = static_cast<float>(random.uniform(-10, 10));
  const auto y = static_cast<float>(random.uniform(-10, 10));
  const auto z = static_cast<float>(random.uniform(-1, 1));
  return {x, y, z};
}

std::vector<Feature> features(std::size_t count) {
  Random random{6};
  std::vector<Feature> all;
  for (std::size_t i = 0; i < count; ++i) {
    all.push_back(
        {random_point(random), 0.0F, static_cast<std::uint8_t>(i * kRings / count), false});
  }
  return all;
}

float squared(const Vector3f& a, const Vector3f& b) {
  return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z);
}

TEST(FeatureIndex, GivenAnyQueryThenTheAnswerIsThatOfTryingAll) {
  const auto all = features(800);
  Index x;
  ASSERT_EQ(x.index.build(all), Status::ok);
  Random random{7};
  int found = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3f q = random_point(random);
    const std::size_t ring = random.below(kRings);
    for (const RingChoice choice : {RingChoice::near, RingChoice::same, RingChoice::other}) {
      for (const float radius : {0.5F, 2.0F}) {
        const std::size_t except = random.below(800);
        std::size_t best = FeatureIndex::kNone;
        for (std::size_t k = 0; k < all.size(); ++k) {
          const auto apart = all[k].ring > ring ? all[k].ring - ring : ring - all[k].ring;
          const bool wanted = choice == RingChoice::near   ? apart <= 2
                              : choice == RingChoice::same ? apart == 0
                                                           : apart <= 2 && apart > 0;
          if (wanted && k != except && squared(all[k].point_m, q) < radius * radius &&
              (best == FeatureIndex::kNone ||
               squared(all[k].point_m, q) < squared(all[best].point_m, q))) {
            best = k;
          }
        }
        ASSERT_EQ(x.index.nearest(q, ring, 2, choice, radius, except), best);
        found += best == FeatureIndex::kNone ? 0 : 1;
      }
    }
  }
  EXPECT_GT(found, 3000);
}

TEST(FeatureIndex, GivenTooManyFeaturesThenItStaysEmpty) {
  Index x;
  EXPECT_EQ(x.index.build(features(1001)), Status::full);
  EXPECT_EQ(x.index.nearest({}, 0, 2, RingChoice::near, 5.0F, FeatureIndex::kNone),
            FeatureIndex::kNone);
  EXPECT_EQ(x.index.build({}), Status::ok);
  EXPECT_EQ(x.index.size(), 0U);
  EXPECT_EQ(x.index.nearest({}, 0, 2, RingChoice::near, 5.0F, FeatureIndex::kNone),
            FeatureIndex::kNone);
}

}  // namespace
}  // namespace picolo
