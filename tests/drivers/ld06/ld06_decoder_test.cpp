// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ld06/ld06_decoder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "ld06_wire.hpp"
#include "support/bytes.hpp"
#include "support/property.hpp"

namespace picolo::test {
namespace {

std::vector<Bytes> decode(Ld06Decoder& decoder, const Bytes& stream) {
  std::vector<Bytes> packets;
  for (const std::uint8_t byte : stream) {
    if (is_ok(decoder.push(byte))) { packets.push_back(wire_bytes(decoder.packet())); }
  }
  return packets;
}

std::vector<Bytes> decode(const Bytes& stream) {
  Ld06Decoder decoder;
  return decode(decoder, stream);
}

Bytes packet_bytes(unsigned index) {
  return wire_bytes(spinning_packet(index));
}

/// A packet with as many headers as fit into its points.
Bytes packet_full_of_headers(unsigned index) {
  Ld06Packet packet = spinning_packet(index);
  for (std::size_t i = 0; i < packet.points.size(); ++i) {
    packet.points.at(i) = i % 2 == 0 ? Ld06Point{0x2C54, 0x54} : Ld06Point{0x542C, 0x2C};
  }
  return wire_bytes(packet);
}

TEST(Ld06Decoder, GivenOnePacketWhenItsLastByteArrivesThenItIsDecoded) {
  const Bytes stream = packet_bytes(3);
  Ld06Decoder decoder;
  for (std::size_t i = 0; i + 1 < stream.size(); ++i) {
    ASSERT_EQ(decoder.push(stream[i]), Status::not_ready);
    ASSERT_EQ(decoder.pending(), i + 1);
  }
  ASSERT_EQ(decoder.push(stream.back()), Status::ok);
  EXPECT_TRUE(equal(decoder.packet(), spinning_packet(3)));
  EXPECT_EQ(decoder.pending(), 0U);
  EXPECT_EQ(decoder.counters().frames, 1U);
  EXPECT_EQ(decoder.counters().skipped_bytes, 0U);
}

TEST(Ld06Decoder, GivenAHalfHeaderBeforeAPacketThenThePacketIsNotLost) {
  // The vendor's parser throws the second 54 away and with it the packet.
  for (const Bytes& prefix :
       {Bytes{0x54}, Bytes{0x54, 0x54}, Bytes{0x54, 0x54, 0x54}, Bytes{0x54, 0x2C}}) {
    Ld06Decoder decoder;
    const Bytes stream = join({prefix, packet_bytes(1), packet_bytes(2)});
    EXPECT_THAT(decode(decoder, stream), testing::ElementsAre(packet_bytes(1), packet_bytes(2)));
    EXPECT_EQ(decoder.counters().skipped_bytes, prefix.size());
  }
}

TEST(Ld06Decoder, GivenAStartInTheMiddleOfAPacketFullOfHeadersThenTheNextPacketIsFound) {
  const Bytes whole = packet_full_of_headers(0);
  for (std::size_t lost = 1; lost < whole.size(); ++lost) {
    const Bytes rest{whole.begin() + static_cast<std::ptrdiff_t>(lost), whole.end()};
    const Bytes next = packet_full_of_headers(1);
    EXPECT_THAT(decode(join({rest, next, packet_bytes(2)})),
                testing::ElementsAre(next, packet_bytes(2)))
        << "first " << lost << " bytes lost";
  }
}

TEST(Ld06Decoder, GivenAnySingleBitFlippedInThreePacketsThenOnlyTheDamagedOneIsLost) {
  const std::vector<Bytes> packets{packet_bytes(0), packet_full_of_headers(1), packet_bytes(2)};
  const Bytes stream = join({packets[0], packets[1], packets[2]});
  for (std::size_t bit = 0; bit < stream.size() * 8; ++bit) {
    std::vector<Bytes> expected = packets;
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(bit / 8 / kLd06PacketSize));
    ASSERT_EQ(decode(with_bit_flipped(stream, bit)), expected) << "bit " << bit;
  }
}

TEST(Ld06Decoder, GivenAnyByteLostThenOnlyItsPacketIsLost) {
  const std::vector<Bytes> packets{packet_full_of_headers(0), packet_bytes(1),
                                   packet_full_of_headers(2)};
  const Bytes stream = join({packets[0], packets[1], packets[2]});
  for (std::size_t at = 0; at < stream.size(); ++at) {
    std::vector<Bytes> expected = packets;
    expected.erase(expected.begin() + static_cast<std::ptrdiff_t>(at / kLd06PacketSize));
    ASSERT_EQ(decode(without_byte(stream, at)), expected) << "byte " << at;
  }
}

TEST(Ld06Decoder, GivenAnyByteInsertedOrDoubledThenAtMostItsPacketIsLost) {
  const std::vector<Bytes> packets{packet_bytes(0), packet_full_of_headers(1), packet_bytes(2)};
  const Bytes stream = join({packets[0], packets[1], packets[2]});
  for (std::size_t at = 0; at < stream.size(); ++at) {
    const std::size_t hit = at / kLd06PacketSize;
    for (const std::uint8_t byte : {stream[at], std::uint8_t{0x54}, std::uint8_t{0x00}}) {
      const std::vector<Bytes> found = decode(with_byte(stream, at, byte));
      std::vector<Bytes> others = packets;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(hit));
      ASSERT_TRUE(found == others || found == packets) << "byte " << at;
      if (at % kLd06PacketSize == 0) {
        ASSERT_EQ(found, packets) << "between packets, byte " << at;
      }
    }
  }
}

TEST(Ld06Decoder, GivenADamagedPacketThenItIsCountedOnce) {
  Ld06Decoder decoder;
  Bytes damaged = packet_bytes(0);
  damaged[10] ^= 0x10U;
  EXPECT_THAT(decode(decoder, join({damaged, packet_bytes(1)})),
              testing::ElementsAre(packet_bytes(1)));
  EXPECT_EQ(decoder.counters().bad_checksums, 1U);
  EXPECT_EQ(decoder.counters().skipped_bytes, kLd06PacketSize);
}

TEST(Ld06Decoder, GivenTwoDecodersFedInTurnsThenNeitherDisturbsTheOther) {
  const Bytes first = join({packet_bytes(0), packet_full_of_headers(1), packet_bytes(2)});
  const Bytes second = join({packet_full_of_headers(7), packet_bytes(8), packet_bytes(9)});
  Ld06Decoder a;
  Ld06Decoder b;
  std::vector<Bytes> from_a;
  std::vector<Bytes> from_b;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (is_ok(a.push(first[i]))) { from_a.push_back(wire_bytes(a.packet())); }
    if (is_ok(b.push(second[i]))) { from_b.push_back(wire_bytes(b.packet())); }
  }
  EXPECT_EQ(from_a, decode(first));
  EXPECT_EQ(from_b, decode(second));
  EXPECT_EQ(from_a.size() + from_b.size(), 6U);
}

TEST(Ld06Decoder, GivenAnglesThatDoNotFitTheSpeedThenThePacketIsImplausible) {
  Ld06Packet packet = spinning_packet(0);
  packet.start_cdeg = 1000;
  packet.end_cdeg = 1000 + 2817;  // 1.5 * 3600 deg/s * 12 / 2300 Hz = 28.17 deg
  Ld06Decoder decoder;
  EXPECT_EQ(decode(decoder, wire_bytes(packet)).size(), 1U);
  packet.end_cdeg += 1;
  EXPECT_EQ(decode(decoder, wire_bytes(packet)).size(), 0U);
  packet.end_cdeg = 999;  // backwards: nearly a full turn
  EXPECT_EQ(decode(decoder, wire_bytes(packet)).size(), 0U);
  packet.start_cdeg = 36001;
  packet.end_cdeg = 36001;
  EXPECT_EQ(decode(decoder, wire_bytes(packet)).size(), 0U);
  EXPECT_EQ(decoder.counters().implausible, 3U);
}

TEST(Ld06Decoder, GivenAStandingMotorThenEqualAnglesAreAccepted) {
  Ld06Packet packet = spinning_packet(0);
  packet.speed_degps = 0;
  packet.start_cdeg = 12345;
  packet.end_cdeg = 12345;
  EXPECT_EQ(decode(wire_bytes(packet)).size(), 1U);
}

TEST(Ld06Decoder, GivenAnInterruptedLineWhenResetThenWhatWaitedIsForgotten) {
  Ld06Decoder decoder;
  const Bytes packet = packet_bytes(5);
  static_cast<void>(decode(decoder, {packet.begin(), packet.begin() + 30}));
  decoder.reset();
  EXPECT_EQ(decoder.pending(), 0U);
  EXPECT_THAT(decode(decoder, packet), testing::ElementsAre(packet));
}

TEST(Ld06Decoder, GivenAMegabyteOfNoiseThenNothingIsBelievedAndTheNextPacketIsFound) {
  Ld06Decoder decoder;
  const std::vector<Bytes> believed = decode(decoder, noise(1'000'000, 42));
  // Odds of a believed packet: 2^-24 a byte times the share of plausible angles, 0.06 expected at
  // most.
  EXPECT_TRUE(believed.empty());
  EXPECT_THAT(decode(decoder, packet_bytes(1)), testing::ElementsAre(packet_bytes(1)));
}

TEST(Ld06Decoder, PropertyWhatAnEncoderWritesIsWhatComesOut) {
  EXPECT_TRUE(rc::check([] {
    Ld06Packet packet;
    packet.speed_degps = *rc::gen::inRange<std::uint16_t>(1000, 6000);
    packet.start_cdeg = *rc::gen::inRange<std::uint16_t>(0, 36000);
    const auto span = *rc::gen::inRange<std::uint16_t>(0, 780);
    packet.end_cdeg = static_cast<std::uint16_t>((packet.start_cdeg + span) % 36000);
    packet.timestamp_ms = *rc::gen::inRange<std::uint16_t>(0, 30000);
    for (Ld06Point& point : packet.points) {
      point = {*rc::gen::arbitrary<std::uint16_t>(), *rc::gen::arbitrary<std::uint8_t>()};
    }
    const Bytes bytes = wire_bytes(packet);
    RC_ASSERT(decode(bytes) == std::vector<Bytes>{bytes});
  }));
}

}  // namespace
}  // namespace picolo::test
