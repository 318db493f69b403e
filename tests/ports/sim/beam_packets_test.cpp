// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Every beam of a recorded scan comes out of the LD06 packets at its own bearing.

#include "picolo/sim/beam_packets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo::sim {
namespace {

struct Point {
  double clockwise_cdeg;
  int range_mm;
};

/// All points of one revolution, unrolled as a driver would interpolate them.
std::vector<Point> revolution(const std::vector<RecordedBeam>& beams, std::size_t left_out = 0) {
  const auto packets = std::make_unique<BeamPackets>();
  EXPECT_EQ(packets->load(beams), left_out);
  std::vector<Point> points;
  double last_end = 0.0;
  Ld06Packet packet;
  while (packets->next(packet) && points.size() < 100'000) {
    const int span = (packet.end_cdeg - packet.start_cdeg + 36'000) % 36'000;
    EXPECT_LE(span, 1200) << "wider than a driver's sanity test allows";
    EXPECT_GE(packet.start_cdeg, last_end) << "angles run backwards";
    last_end = packet.start_cdeg + span;
    for (std::size_t i = 0; i < kLd06Points; ++i) {
      points.push_back(
          {packet.start_cdeg + span * static_cast<double>(i) / 11.0, packet.range_mm[i]});
    }
  }
  EXPECT_GT(points.back().clockwise_cdeg, 35'800.0) << "the revolution does not come round";
  EXPECT_LT(points.back().clockwise_cdeg, 37'200.0);
  return points;
}

double clockwise(const RecordedBeam& beam) {
  const double cdeg = -static_cast<double>(beam.bearing_rad) * 18'000.0 / std::numbers::pi;
  return cdeg - 36'000.0 * std::floor((cdeg + 0.5) / 36'000.0);
}

/// Every beam with a range is found within `tolerance_cdeg`, and there are no others.
void expect_all_beams(const std::vector<RecordedBeam>& beams, double tolerance_cdeg) {
  std::vector<Point> hits;
  for (const Point& point : revolution(beams)) {
    if (point.range_mm > 0) { hits.push_back(point); }
  }
  std::vector<Point> expected;
  for (const RecordedBeam& beam : beams) {
    if (beam.range_m > 0.0F) {
      expected.push_back({clockwise(beam), static_cast<int>(std::lround(beam.range_m * 1000.0F))});
    }
  }
  std::sort(expected.begin(), expected.end(),
            [](const Point& a, const Point& b) { return a.clockwise_cdeg < b.clockwise_cdeg; });
  ASSERT_EQ(hits.size(), expected.size());
  for (std::size_t i = 0; i < hits.size(); ++i) {
    EXPECT_NEAR(hits[i].clockwise_cdeg, expected[i].clockwise_cdeg, tolerance_cdeg) << i;
    EXPECT_EQ(hits[i].range_mm, expected[i].range_mm) << i;
  }
}

/// `count` beams from `begin_deg` on, counter-clockwise, each with a range of its own.
std::vector<RecordedBeam> fan(int count, double begin_deg, double step_deg) {
  std::vector<RecordedBeam> beams;
  for (int k = 0; k < count; ++k) {
    const double bearing_deg = begin_deg + k * step_deg;
    beams.push_back({static_cast<float>(1000 + k) / 1000.0F,
                     static_cast<float>(bearing_deg * std::numbers::pi / 180.0)});
  }
  return beams;
}

struct Fan {
  int count;
  double begin_deg;
  double step_deg;
  double tolerance_cdeg;
};

class RecordedFans : public ::testing::TestWithParam<Fan> {};

TEST_P(RecordedFans, ComeOutAtTheirOwnBearings) {
  const Fan& f = GetParam();
  expect_all_beams(fan(f.count, f.begin_deg, f.step_deg), f.tolerance_cdeg);
}

INSTANTIATE_TEST_SUITE_P(OfKnownLidars, RecordedFans,
                         ::testing::Values(Fan{360, -90, 0.5, 0.01},  // SICK, half degrees
                                           Fan{361, -90, 0.5, 0.01},  //
                                           Fan{180, -90, 1.0, 0.01},  // SICK, whole degrees
                                           Fan{181, -90, 1.0, 0.01},  //
                                           Fan{682, -119.885, 0.3515625, 2.0},  // URG-04LX
                                           Fan{1081, -135, 0.25, 2.0},          // UTM-30LX
                                           Fan{720, -180, 0.5, 0.01},           // all around
                                           Fan{90, -90, 2.0, 2.0},    // coarser than the grid
                                           Fan{12, -180, 30.0, 2.0},  //
                                           Fan{3, 10, 0.0, 2.0},      // one direction
                                           Fan{1, 0, 1.0, 0.01}));

TEST(BeamPackets, GivenHalfDegreesThenTheBearingsAreExact) {
  int seen = 0;
  for (const Point& point : revolution(fan(360, -90, 0.5))) {
    if (point.range_mm == 0) { continue; }
    const double half_degrees = point.clockwise_cdeg / 50.0;
    EXPECT_DOUBLE_EQ(half_degrees, std::round(half_degrees));
    ++seen;
  }
  EXPECT_EQ(seen, 360);
}

TEST(BeamPackets, GivenUnevenBearingsThenEachIsStillHit) {
  Random random{3};
  for (int round = 0; round < 50; ++round) {
    std::vector<RecordedBeam> beams;
    double bearing_deg = -180.0;
    for (int k = 0; k < 400; ++k) {
      bearing_deg += random.uniform(0.05, 1.7);
      if (bearing_deg > 179.9) { break; }
      beams.push_back({static_cast<float>(1000 + k) / 1000.0F,
                       static_cast<float>(bearing_deg * std::numbers::pi / 180.0)});
    }
    expect_all_beams(beams, 2.0);
  }
}

TEST(BeamPackets, GivenClockwiseOrderThenTheSameRevolution) {
  auto beams = fan(361, -90, 0.5);
  const auto expected = revolution(beams);
  std::reverse(beams.begin(), beams.end());
  const auto points = revolution(beams);
  ASSERT_EQ(points.size(), expected.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].range_mm, expected[i].range_mm);
  }
}

TEST(BeamPackets, GivenRangesThatTheWireCannotExpressThenNothingCameBack) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<RecordedBeam> beams{{0.0F, 0.0F},   {-1.0F, 0.1F},  {kInfinity, 0.2F},
                                        {kNan, 0.3F},   {81.83F, 0.4F}, {65.536F, 0.5F},
                                        {65.535F, 0.6F}};
  int hits = 0;
  for (const Point& point : revolution(beams)) {
    if (point.range_mm == 0) { continue; }
    EXPECT_EQ(point.range_mm, 65'535);
    ++hits;
  }
  EXPECT_EQ(hits, 1);
}

TEST(BeamPackets, GivenBeamsWithoutDirectionThenTheyAreLeftOutAndReported) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  revolution({{1.0F, kNan}, {1.0F, 1e6F}, {1.0F, 0.5F}}, 2);
}

TEST(BeamPackets, GivenNoBeamsThenAnEmptyRevolution) {
  for (const Point& point : revolution({})) { EXPECT_EQ(point.range_mm, 0); }
}

TEST(BeamPackets, GivenTooManyBeamsThenTheRestIsReported) {
  const auto packets = std::make_unique<BeamPackets>();
  EXPECT_EQ(packets->load(fan(static_cast<int>(BeamPackets::kMaxBeams) + 5, -180, 0.08)), 5U);
}

}  // namespace
}  // namespace picolo::sim
