// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// What the wire can do to every serial protocol, exhaustively where it is small, with the figures
// printed as a table: packets lost for a damaged one, false accepts, bytes to find the way back.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "wires.hpp"

namespace picolo::test {
namespace {

constexpr std::uint32_t kBefore = 8;   ///< good packets in front of the damage
constexpr std::uint32_t kDamaged = 3;  ///< packets that are damaged in turn
constexpr std::uint32_t kBehind = 8;

struct Figures {
  std::size_t cases = 0;
  std::size_t worst_lost = 0;      ///< packets lost in one case, beyond those that were hit
  std::size_t following_lost = 0;  ///< cases in which a packet behind the damage was lost
  std::size_t false_accepts = 0;   ///< packets handed out that were never sent
  std::size_t worst_resync = 0;    ///< bytes behind the damaged packet until the next came out
};

struct Stream {
  Bytes bytes;
  std::vector<std::size_t> ends;  ///< of every packet
  std::size_t first_damaged = 0;  ///< where packet kBefore begins
};

Stream make_stream(const Wire& wire) {
  Stream stream;
  for (std::uint32_t i = 0; i < kBefore + kDamaged + kBehind; ++i) {
    if (i == kBefore) { stream.first_damaged = stream.bytes.size(); }
    const Bytes packet = wire.packet(i);
    stream.bytes.insert(stream.bytes.end(), packet.begin(), packet.end());
    stream.ends.push_back(stream.bytes.size());
  }
  return stream;
}

/// `hit_first` to `hit_last`: the packets whose bytes were touched. `shift`: bytes that were
/// added (or, negative, taken away).
void judge(const Wire& wire, const Stream& stream, const Bytes& damaged, std::size_t hit_first,
           std::size_t hit_last, std::ptrdiff_t shift, Figures& figures) {
  ++figures.cases;
  const std::vector<Accepted> found = wire.read(damaged);
  const auto last_sent = static_cast<std::uint32_t>(stream.ends.size());
  std::set<std::uint32_t> seen;
  for (const Accepted& packet : found) {
    if (!packet.intact || packet.number >= last_sent || !seen.insert(packet.number).second) {
      ++figures.false_accepts;
    }
  }
  // What never comes out of an undamaged stream (a capsule waits for its successor) is not lost.
  const std::vector<Accepted> undamaged = wire.read(stream.bytes);
  std::size_t lost_elsewhere = 0;
  bool following = false;
  for (const Accepted& packet : undamaged) {
    if (packet.number >= hit_first && packet.number <= hit_last) { continue; }
    if (seen.count(packet.number) != 0) { continue; }
    ++lost_elsewhere;
    following = following || packet.number > hit_last;
  }
  figures.worst_lost = std::max(figures.worst_lost, lost_elsewhere);
  figures.following_lost += following ? 1U : 0U;
  const auto end_of_hit =
      static_cast<std::ptrdiff_t>(stream.ends[hit_last]) + std::max<std::ptrdiff_t>(shift, 0);
  for (const Accepted& packet : found) {
    if (packet.number <= hit_last || !packet.intact) { continue; }
    const std::ptrdiff_t wait = static_cast<std::ptrdiff_t>(packet.at) - end_of_hit;
    figures.worst_resync =
        std::max(figures.worst_resync, static_cast<std::size_t>(std::max<std::ptrdiff_t>(wait, 0)));
    break;
  }
}

std::size_t packet_of(const Stream& stream, std::size_t byte) {
  return static_cast<std::size_t>(std::upper_bound(stream.ends.begin(), stream.ends.end(), byte) -
                                  stream.ends.begin());
}

void print(const char* fault, const Wire& wire, const Figures& figures) {
  std::printf("%-14s %-15s %7zu %10zu %10zu %8zu %8zu\n", wire.name.c_str(), fault, figures.cases,
              figures.worst_lost, figures.following_lost, figures.false_accepts,
              figures.worst_resync);
}

void print_header() {
  std::printf("%-14s %-15s %7s %10s %10s %8s %8s\n", "protocol", "fault", "cases", "lost else",
              "following", "false", "resync");
}

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
  }
}

/// Bits whose loss nothing on this wire can show: five-byte nodes protect two bits of forty.
bool undetectable(const Wire& wire) {
  return wire.name == "rplidar 0x81";
}

TEST(WireFaults, GivenAnySingleBitFlippedThenOnlyItsPacketIsLost) {
  print_header();
  for (const Wire& wire : all_wires()) {
    SCOPED_TRACE(wire.name);
    const Stream stream = make_stream(wire);
    const std::size_t end = stream.ends[kBefore + kDamaged - 1];
    Figures figures;
    for (std::size_t bit = 8 * stream.first_damaged; bit < 8 * end; ++bit) {
      const std::size_t packet = packet_of(stream, bit / 8);
      judge(wire, stream, with_bit_flipped(stream.bytes, bit), packet, packet, 0, figures);
    }
    print("bit flip", wire, figures);
    EXPECT_EQ(figures.worst_lost, 0U);
    EXPECT_EQ(figures.following_lost, 0U);
    if (!undetectable(wire)) { EXPECT_EQ(figures.false_accepts, 0U); }
    EXPECT_LE(figures.worst_resync, wire.packet(0).size() + wire.lag + 5);
  }
}

TEST(WireFaults, GivenAByteLostAddedOrDoubledThenOnlyItsPacketIsLost) {
  print_header();
  for (const Wire& wire : all_wires()) {
    SCOPED_TRACE(wire.name);
    const Stream stream = make_stream(wire);
    const std::size_t end = stream.ends[kBefore + kDamaged - 1];
    Figures lost;
    Figures added;
    Figures doubled;
    for (std::size_t at = stream.first_damaged; at < end; ++at) {
      const std::size_t packet = packet_of(stream, at);
      judge(wire, stream, without_byte(stream.bytes, at), packet, packet, -1, lost);
      // A byte added in front of the first one stands between two packets and hits neither; it may
      // still look like the header of the one behind it.
      for (const int byte : {0x00, 0xFF, 0xAA, 0x55, 0x54, 0x0A}) {
        judge(wire, stream, with_byte(stream.bytes, at, static_cast<std::uint8_t>(byte)), packet,
              packet, 1, added);
      }
      judge(wire, stream, with_byte(stream.bytes, at, stream.bytes[at]), packet, packet, 1,
            doubled);
    }
    print("byte lost", wire, lost);
    print("byte added", wire, added);
    print("byte doubled", wire, doubled);
    for (const Figures& figures : {lost, added, doubled}) {
      EXPECT_EQ(figures.following_lost, 0U);
      EXPECT_LE(figures.worst_lost, 1U);
      if (!undetectable(wire)) { EXPECT_LE(figures.false_accepts, figures.cases / 200); }
      EXPECT_LE(figures.worst_resync, wire.packet(0).size() + wire.lag + 6);
    }
  }
}

TEST(WireFaults, GivenBurstsThenOnlyTheHitPacketsAreLost) {
  print_header();
  Random random{7};
  for (const Wire& wire : all_wires()) {
    SCOPED_TRACE(wire.name);
    const Stream stream = make_stream(wire);
    Figures figures;
    for (int i = 0; i < 400; ++i) {
      const std::size_t room = stream.ends[kBefore + kDamaged - 1] - stream.first_damaged;
      const std::size_t begin =
          stream.first_damaged + random.below(static_cast<std::uint32_t>(room - 2));
      const std::size_t longest =
          std::min<std::size_t>(40, stream.ends[kBefore + kDamaged - 1] - begin);
      const std::size_t length = 1 + random.below(static_cast<std::uint32_t>(longest));
      Bytes damaged = stream.bytes;
      for (std::size_t k = begin; k < begin + length; ++k) {
        damaged[k] = static_cast<std::uint8_t>(random.below(256));
      }
      judge(wire, stream, damaged, packet_of(stream, begin), packet_of(stream, begin + length - 1),
            0, figures);
    }
    print("burst", wire, figures);
    EXPECT_LE(figures.worst_lost, undetectable(wire) ? 2U : 0U);
    if (!undetectable(wire)) { EXPECT_LE(figures.false_accepts, 4U); }
  }
}

TEST(WireFaults, GivenAMegabyteOfNoiseThenAlmostNothingIsBelievedAndTheNextPacketsAreFound) {
  std::printf("%-14s %10s %12s\n", "protocol", "believed", "expected at most");
  const Bytes megabyte = noise(1'000'000, 3);
  for (const Wire& wire : all_wires()) {
    SCOPED_TRACE(wire.name);
    const std::size_t believed = wire.read(megabyte).size();
    // rplidar: five nodes in a row, ten check bits and four angles within 24 of 360 (and of 512)
    // degrees; the others: header and checksum.
    const double odds =
        wire.name == "rplidar 0x81" ? std::exp2(-10.0) * 0.1 * 0.2 : std::exp2(-wire.checksum_bits);
    const double expected = wire.name == "scip" ? 0.0 : 1e6 * odds;
    std::printf("%-14s %10zu %12.1f\n", wire.name.c_str(), believed, 4 * expected + 3);
    EXPECT_LE(static_cast<double>(believed), 4 * expected + 3);

    Bytes stream{megabyte.begin(), megabyte.begin() + 5000};
    for (std::uint32_t i = 0; i < 20; ++i) {
      const Bytes packet = wire.packet(i);
      stream.insert(stream.end(), packet.begin(), packet.end());
    }
    std::set<std::uint32_t> good;
    for (const Accepted& packet : wire.read(stream)) {
      if (packet.intact && packet.at > 5000) { good.insert(packet.number); }
    }
    EXPECT_GE(good.size(), 16U);
  }
}

/// What a receiver at another rate makes of a line: it samples bits at its own times.
Bytes at_rate(const Bytes& sent, double receiver_over_sender) {
  std::vector<bool> line(20, true);
  for (const std::uint8_t byte : sent) {
    line.push_back(false);
    for (int bit = 0; bit < 8; ++bit) { line.push_back(((byte >> bit) & 1) != 0); }
    line.push_back(true);
  }
  line.resize(line.size() + 40, true);
  const double step = 1.0 / receiver_over_sender;
  Bytes received;
  for (double at = 0.0; at + 10 * step < static_cast<double>(line.size());) {
    if (line[static_cast<std::size_t>(at)]) {
      at += 0.25;
      continue;
    }
    unsigned byte = 0;
    for (int bit = 0; bit < 8; ++bit) {
      const auto sample = static_cast<std::size_t>(at + (1.5 + bit) * step);
      byte |= line[sample] ? 1U << bit : 0U;
    }
    received.push_back(static_cast<std::uint8_t>(byte));
    at += 9.5 * step;
  }
  return received;
}

TEST(WireFaults, GivenHalfOrDoubleTheBaudRateThenNothingIsBelieved) {
  for (const Wire& wire : all_wires()) {
    SCOPED_TRACE(wire.name);
    Bytes stream;
    for (std::uint32_t i = 0; i < 190 && i < wire.numbers; ++i) {
      const Bytes packet = wire.packet(i);
      stream.insert(stream.end(), packet.begin(), packet.end());
    }
    ASSERT_EQ(at_rate(stream, 1.0), stream);
    for (const double ratio : {0.5, 2.0}) {
      const Bytes received = at_rate(stream, ratio);
      EXPECT_GT(received.size(), 100U);
      EXPECT_LE(wire.read(received).size(), 3U) << ratio;
    }
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

/// A terminal left in canonical mode swallows or changes control characters.
TEST(WireFaults, GivenTheDamageOfACanonicalTerminalThenOnlyTheHitPacketsAreLost) {
  for (const Wire& wire : all_wires()) {
    SCOPED_TRACE(wire.name);
    Bytes stream;
    std::size_t untouched = 0;
    constexpr std::uint32_t kPackets = 60;
    for (std::uint32_t i = 0; i < kPackets && i < wire.numbers; ++i) {
      bool hit = false;
      for (const std::uint8_t byte : wire.packet(i)) {
        const bool swallowed = byte == 0x03 || byte == 0x04 || byte == 0x11 || byte == 0x13 ||
                               byte == 0x16 || byte == 0x1A || byte == 0x1C;
        const bool changed = byte == 0x0D;
        hit = hit || swallowed || changed;
        if (!swallowed) { stream.push_back(changed ? std::uint8_t{0x0A} : byte); }
      }
      untouched += hit ? 0U : 1U;
    }
    std::set<std::uint32_t> good;
    std::size_t wrong = 0;
    for (const Accepted& packet : wire.read(stream)) {
      if (packet.intact) { good.insert(packet.number); }
      wrong += packet.intact ? 0U : 1U;
    }
    EXPECT_GE(good.size() + 1 + (undetectable(wire) ? untouched / 3 : 0), untouched);
    if (!undetectable(wire)) { EXPECT_LE(wrong, 1U); }
  }
}

}  // namespace
}  // namespace picolo::test
