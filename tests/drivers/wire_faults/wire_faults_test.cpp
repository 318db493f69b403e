// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// What the wire can do to every serial protocol, exhaustively where it is small, held to the bounds
// and to the committed table.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "picolo/devices/wrong_rate.hpp"
#include "support/data.hpp"
#include "wire_figures.hpp"

namespace picolo::test {
namespace {

TEST(WireFaults, GivenASoundStreamThenEveryPacketComesOutOnce) {
  for (const Wire& wire : all_wires()) {
    SCOPED_TRACE(wire.name);
    Bytes stream;
    for (std::uint32_t i = 0; i < 30; ++i) {
      const Bytes packet = wire.packet(i);
      stream.insert(stream.end(), packet.begin(), packet.end());
    }
    const auto found = wire.read(stream);
    EXPECT_GE(found.size(), 29U);
    EXPECT_TRUE(std::all_of(found.begin(), found.end(), [](auto& p) { return p.intact; }));
    EXPECT_EQ(devices::received_at(stream, 9600, 9600), stream);
  }
}

TEST(WireFaults, GivenSilenceAndTheEndThenNothingIsInvented) {
  for (const Wire& wire : all_wires()) {
    SCOPED_TRACE(wire.name);
    EXPECT_TRUE(wire.read({}).empty());
    const Bytes packet = wire.packet(1);
    for (std::size_t size = 0; size < packet.size(); ++size) {
      const auto found =
          wire.read({packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size)});
      EXPECT_TRUE(std::all_of(found.begin(), found.end(), [](auto& p) { return p.intact; }))
          << size;
    }
  }
}

void expect_within_bounds(const WireFigures& figures) {
  const Wire& wire = figures.wire;
  for (std::size_t i = 0; i < figures.faults.size(); ++i) {
    const Figures& f = figures.faults[i];
    SCOPED_TRACE(all_faults()[i].name);
    const bool one_bit = i == 0;
    // What was believed by the odds of a checksum may have swallowed what stood behind it.
    EXPECT_LE(f.following_lost, undetectable(wire) ? 0U : f.false_accepts);
    EXPECT_LE(f.worst_lost, one_bit ? 0U : 1U);
    if (f.following_lost == 0) { EXPECT_LE(f.worst_resync, wire.packet(0).size() + wire.lag + 6); }
    if (undetectable(wire)) { continue; }
    EXPECT_LE(f.false_accepts, one_bit ? 0U : 3 + f.cases / 256);
  }
  EXPECT_LE(static_cast<double>(figures.noise.believed), 4 * figures.noise.expected + 3);
  EXPECT_GE(figures.noise.found_behind, 16U);
  EXPECT_LE(figures.believed_at_half, 3U);
  EXPECT_LE(figures.believed_at_double, 3U);
  const CanonicalFigures& canonical = figures.canonical;
  EXPECT_GE(canonical.found + 1 + (undetectable(wire) ? canonical.untouched / 3 : 0),
            canonical.untouched);
  if (!undetectable(wire)) { EXPECT_LE(canonical.wrong, 1U); }
}

/// The figures are read by people, too: what changes them is committed with them. PICOLO_WRITE=1
/// writes the page anew.
TEST(WireFaults, GivenEveryFaultThenTheTableIsWithinTheBoundsAndTheOneInTheDocs) {
  std::vector<WireFigures> all;
  for (const Wire& wire : all_wires()) {
    SCOPED_TRACE(wire.name);
    all.push_back(measure(wire));
    expect_within_bounds(all.back());
  }
  const auto page = source_dir() / "docs" / "wire_faults.md";
  std::stringstream text;
  text << std::ifstream{page}.rdbuf();
  const std::string table = to_table(all);
  std::printf("%s", table.c_str());
  const std::size_t begin = text.str().find("| protocol |");
  ASSERT_NE(begin, std::string::npos);
  if (std::getenv("PICOLO_WRITE") != nullptr) {
    std::ofstream{page} << text.str().substr(0, begin) << table;
    return;
  }
  EXPECT_EQ(text.str().substr(begin), table);
}

}  // namespace
}  // namespace picolo::test
