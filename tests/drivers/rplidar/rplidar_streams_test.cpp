// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Recorded RPLIDAR A1 streams against what the vendor's library makes of them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "picolo/drivers/rplidar/rplidar.hpp"
#include "support/bytes.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

constexpr const char* kFolder = "drivers/rplidar";

struct NodeAt {
  RplidarNode node{};
  std::size_t end = 0;  ///< bytes up to and including its last
};

bool equal(const RplidarNode& a, const RplidarNode& b) {
  return a.angle_z_q14 == b.angle_z_q14 && a.dist_mm_q2 == b.dist_mm_q2 && a.quality == b.quality &&
         (a.flag & 1U) == (b.flag & 1U);
}

Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

std::vector<RplidarNode> read_nodes(const std::filesystem::path& path) {
  std::ifstream file{path};
  std::string line;
  std::getline(file, line);
  std::vector<RplidarNode> nodes;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream fields{line};
    unsigned angle = 0;
    unsigned dist = 0;
    unsigned quality = 0;
    unsigned flag = 0;
    fields >> angle >> dist >> quality >> flag;
    nodes.push_back({.dist_mm_q2 = dist,
                     .angle_z_q14 = static_cast<std::uint16_t>(angle),
                     .quality = static_cast<std::uint8_t>(quality),
                     .flag = static_cast<std::uint8_t>(flag)});
  }
  return nodes;
}

std::vector<RplidarNode> decode(const Bytes& stream) {
  RplidarProtocol protocol{{.active = false}};
  std::vector<RangeReading> readings(RplidarProtocol::kMaxSamplesPerByte);
  std::vector<RplidarNode> nodes;
  for (const std::uint8_t byte : stream) {
    protocol.push(byte, {}, readings);
    nodes.insert(nodes.end(), protocol.nodes().begin(), protocol.nodes().end());
  }
  while (protocol.flush() > 0) {
    nodes.insert(nodes.end(), protocol.nodes().begin(), protocol.nodes().end());
  }
  return nodes;
}

double step_deg(const RplidarNode& a, const RplidarNode& b) {
  return std::remainder((b.angle_z_q14 - a.angle_z_q14) * 90.0 / 16384.0, 360.0);
}

/// A node that no A1 can have measured: beyond its range of 12 m, or at an angle where neither its
/// predecessor nor its successor was.
std::size_t false_nodes(const std::vector<RplidarNode>& nodes) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const bool far = nodes[i].dist_mm_q2 > 4 * 13'000;
    const bool after = i == 0 || std::abs(step_deg(nodes[i - 1], nodes[i])) > 12.0;
    const bool before = i + 1 == nodes.size() || std::abs(step_deg(nodes[i], nodes[i + 1])) > 12.0;
    count += far || (after && before) ? 1U : 0U;
  }
  return count;
}

/// The longest way to walk both lists: how many nodes of either are not in the other, and how many
/// places there are where they differ (runs apart by more than ten nodes).
struct Difference {
  std::size_t only_ours = 0;
  std::size_t only_theirs = 0;
  std::size_t places = 0;
  std::size_t widest = 0;
};

Difference compare(const std::vector<RplidarNode>& ours, const std::vector<RplidarNode>& theirs) {
  Difference result;
  std::size_t i = 0;
  std::size_t k = 0;
  constexpr std::size_t kReach = 40;
  while (i < ours.size() || k < theirs.size()) {
    if (i < ours.size() && k < theirs.size() && equal(ours[i], theirs[k])) {
      ++i;
      ++k;
      continue;
    }
    // The nearest place from which three nodes agree again.
    bool found = false;
    for (std::size_t sum = 1; sum <= 2 * kReach && !found; ++sum) {
      for (std::size_t a = 0; a <= sum && !found; ++a) {
        const std::size_t b = sum - a;
        bool agrees = true;
        for (std::size_t n = 0; n < 3 && agrees; ++n) {
          const bool end = i + a + n >= ours.size() && k + b + n >= theirs.size();
          agrees = end || (i + a + n < ours.size() && k + b + n < theirs.size() &&
                           equal(ours[i + a + n], theirs[k + b + n]));
        }
        if (!agrees) { continue; }
        found = true;
        ++result.places;
        result.only_ours += std::min(a, ours.size() - i);
        result.only_theirs += std::min(b, theirs.size() - k);
        result.widest = std::max({result.widest, a, b});
        i += a;
        k += b;
      }
    }
    if (!found) {
      result.only_ours += ours.size() - i;
      result.only_theirs += theirs.size() - k;
      result.widest = 9999;
      break;
    }
  }
  return result;
}

TEST(RplidarStreams, GivenRecordedStreamsThenOnlyTheNodesAtByteSlipsDifferFromTheVendors) {
  PICOLO_NEED_DATA(kFolder);
  std::size_t ours_false = 0;
  std::size_t theirs_false = 0;
  std::size_t streams = 0;
  for (const auto& entry : std::filesystem::directory_iterator{data_path(kFolder)}) {
    if (entry.path().extension() != ".bin") { continue; }
    SCOPED_TRACE(entry.path().filename());
    ++streams;
    std::filesystem::path reference = entry.path();
    reference.replace_extension(".sdk_nodes.csv");
    const std::vector<RplidarNode> theirs = read_nodes(reference);
    const std::vector<RplidarNode> ours = decode(read_bytes(entry.path()));
    ASSERT_GT(theirs.size(), 1000U);
    const Difference difference = compare(ours, theirs);
    // Start, end and at most two slips; around each the lists differ by ten nodes at most.
    EXPECT_LE(difference.places, 4U);
    EXPECT_LE(difference.widest, 10U);
    EXPECT_EQ(false_nodes(ours), 0U);
    ours_false += false_nodes(ours);
    theirs_false += false_nodes(theirs);
    std::cout << entry.path().filename() << ": " << ours.size() << " nodes, vendor "
              << theirs.size() << "; only ours " << difference.only_ours << ", only the vendor's "
              << difference.only_theirs << " at " << difference.places << " places, widest "
              << difference.widest << "; false nodes " << false_nodes(ours) << ", vendor "
              << false_nodes(theirs) << '\n';
  }
  EXPECT_EQ(streams, 6U);
  EXPECT_LT(ours_false, theirs_false);
  std::cout << "false nodes " << ours_false << ", vendor " << theirs_false << '\n';
}

TEST(RplidarStreams, GivenRealUltraCapsulesThenEveryNodeIsAsPublished) {
  const char* name = "drivers/rplidar/ultra_capsules_0x84.json";
  PICOLO_NEED_DATA(name);
  std::ifstream file{data_path(name)};
  const nlohmann::json data = nlohmann::json::parse(file);
  RplidarProtocol protocol{{.mode = RplidarMode::ultra, .active = false}};
  std::vector<RangeReading> readings(RplidarProtocol::kMaxSamplesPerByte);
  std::vector<RplidarNode> nodes;
  for (const auto& capsule : data.at("capsules")) {
    for (const std::uint8_t byte : from_hex(capsule.get<std::string>())) {
      protocol.push(byte, {}, readings);
      nodes.insert(nodes.end(), protocol.nodes().begin(), protocol.nodes().end());
    }
  }
  std::size_t at = 0;
  for (const auto& capsule : data.at("decoded")) {
    for (const auto& expected : capsule) {
      ASSERT_LT(at, nodes.size());
      SCOPED_TRACE(at);
      EXPECT_EQ(nodes[at].flag, expected.at(0).get<unsigned>());
      EXPECT_EQ(nodes[at].quality, expected.at(1).get<unsigned>());
      EXPECT_EQ(nodes[at].angle_z_q14, expected.at(2).get<unsigned>());
      EXPECT_EQ(nodes[at].dist_mm_q2, expected.at(3).get<unsigned>());
      ++at;
    }
  }
  EXPECT_EQ(at, nodes.size());
  EXPECT_EQ(at, 192U);
}

}  // namespace
}  // namespace picolo::test
