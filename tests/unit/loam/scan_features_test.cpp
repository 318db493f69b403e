// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/odometry/scan_features.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace picolo {
namespace {

constexpr std::size_t kMost = 2000;

class Features : public ::testing::Test {
 protected:
  Status find(const std::vector<RingPoint>& ring, const FeatureConfig& config = {}) {
    edges_.clear();
    surfaces_.clear();
    return find_features(ring, 3, config, {range_, bend_, order_, flags_}, edges_, surfaces_);
  }
  [[nodiscard]] bool has_edge_near(float x, float y, float radius) const {
    for (const Feature& f : edges_.view()) {
      if (std::hypot(f.point_m.x - x, f.point_m.y - y) < radius) { return true; }
    }
    return false;
  }

  std::array<float, kMost> range_{};
  std::array<float, kMost> bend_{};
  std::array<std::uint16_t, kMost> order_{};
  std::array<std::uint8_t, kMost> flags_{};
  std::array<Feature, 200> edge_storage_{};
  std::array<Feature, 400> surface_storage_{};
  FeatureList edges_{edge_storage_};
  FeatureList surfaces_{surface_storage_};
};

/// Beams from -60 to 60 deg against `range(angle)`.
template <typename Range>
std::vector<RingPoint> fan(const Range& range, std::size_t count = 600) {
  std::vector<RingPoint> ring;
  for (std::size_t i = 0; i < count; ++i) {
    const float angle = -1.05F + 2.1F * static_cast<float>(i) / static_cast<float>(count);
    const float r = range(angle);
    ring.push_back({{r * std::cos(angle), r * std::sin(angle), 0.1F}, 0.0F});
  }
  return ring;
}

float wall(float angle) {
  return 10.0F / std::cos(angle);
}

/// Two walls that meet at (10, 0) with a right angle pointing away.
float corner(float angle) {
  return 10.0F / (std::abs(std::sin(angle)) + std::cos(angle));
}

TEST_F(Features, GivenAFlatWallThenThereAreSurfacesAndNoEdges) {
  ASSERT_EQ(find(fan(wall)), Status::ok);
  EXPECT_EQ(edges_.size(), 0U);
  EXPECT_GT(surfaces_.size(), 40U);
  int strong = 0;
  for (const Feature& f : surfaces_.view()) {
    EXPECT_NEAR(f.point_m.x, 10.0F, 1e-4F);
    EXPECT_EQ(f.ring, 3);
    strong += f.strong ? 1 : 0;
  }
  EXPECT_EQ(strong, 24);  // four in each of six sectors
}

TEST_F(Features, GivenACornerThenItIsTheOnlyEdge) {
  ASSERT_EQ(find(fan(corner)), Status::ok);
  ASSERT_EQ(edges_.size(), 1U);
  EXPECT_TRUE(has_edge_near(10.0F, 0.0F, 0.1F));
  EXPECT_TRUE(edges_.view()[0].strong);
}

TEST_F(Features, GivenAnObjectInFrontThenItsRimIsAnEdgeAndTheHiddenWallIsNone) {
  const auto ring = fan([](float a) { return std::abs(a) < 0.2F ? 5.0F / std::cos(a) : wall(a); });
  ASSERT_EQ(find(ring), Status::ok);
  for (const Feature& f : edges_.view()) { EXPECT_NEAR(f.point_m.x, 5.0F, 0.01F); }
  EXPECT_TRUE(has_edge_near(5.0F, 5.0F * std::tan(0.2F), 0.1F));
  EXPECT_TRUE(has_edge_near(5.0F, -5.0F * std::tan(0.2F), 0.1F));
}

TEST_F(Features, GivenABeamAlongTheSurfaceThenNothingIsTaken) {
  // A wall along the beam: each return 1 m farther than the last.
  std::vector<RingPoint> ring;
  for (int i = 0; i < 40; ++i) {
    const float r = 5.0F + static_cast<float>(i);
    const float angle = 0.003F * static_cast<float>(i);
    ring.push_back({{r * std::cos(angle), r * std::sin(angle), 0.0F}, 0.0F});
  }
  ASSERT_EQ(find(ring), Status::ok);
  EXPECT_EQ(edges_.size() + surfaces_.size(), 0U);
}

TEST_F(Features, GivenMissingReturnsThenTheirNeighboursAreNotTaken) {
  auto ring = fan(wall);
  ring.erase(ring.begin() + 290, ring.begin() + 310);
  const auto nan = std::numeric_limits<float>::quiet_NaN();
  ring[100].point_m = {nan, nan, nan};
  ring[150].point_m = {0, 0, 0};
  ring[200].point_m = {1e9F, 0, 0};
  ASSERT_EQ(find(ring), Status::ok);
  EXPECT_EQ(edges_.size(), 0U);
  for (const Feature& f : surfaces_.view()) {
    for (const std::size_t hole : {290U, 100U, 150U, 200U}) {
      for (std::size_t i = hole - 4; i < hole + 4; ++i) {
        EXPECT_FALSE(f.point_m == ring[i].point_m) << "return " << i;
      }
    }
    EXPECT_NEAR(f.point_m.x, 10.0F, 1e-4F);
  }
}

TEST_F(Features, GivenLimitsThenSectorsKeepThem) {
  const auto zigzag = [](float a) {
    return wall(a) + 5.0F * std::abs(std::fmod(a + 2.0F, 0.2F) - 0.1F);
  };
  const FeatureConfig config{.strong_edges = 1, .edges = 2, .depth_step_m = 5.0F};
  const auto ring = fan(zigzag, 400);
  ASSERT_EQ(find(ring, config), Status::ok);
  EXPECT_LE(edges_.size(), 12U);
  EXPECT_GE(edges_.size(), 6U);
  int strong = 0;
  for (const Feature& f : edges_.view()) { strong += f.strong ? 1 : 0; }
  EXPECT_LE(strong, 6);
}

TEST_F(Features, GivenTooLongARingOrABadConfigurationThenItIsRefused) {
  EXPECT_EQ(find(fan(wall, kMost + 1)), Status::full);
  EXPECT_EQ(find(fan(wall), {.sectors = 0}), Status::invalid_argument);
  EXPECT_EQ(find({}), Status::ok);
  EXPECT_EQ(find(fan(wall, 10)), Status::ok);
  EXPECT_EQ(surfaces_.size(), 0U);
}

TEST_F(Features, GivenFullStorageThenTheRestIsCounted) {
  std::array<Feature, 10> small{};
  FeatureList surfaces{small};
  ASSERT_EQ(find_features(fan(wall), 0, {}, {range_, bend_, order_, flags_}, edges_, surfaces),
            Status::ok);
  EXPECT_EQ(surfaces.size(), 10U);
  EXPECT_GT(surfaces.dropped(), 20U);
}

}  // namespace
}  // namespace picolo
