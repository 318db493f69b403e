// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/witmotion/witmotion_frame.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "support/bytes.hpp"
#include "support/property.hpp"
#include "support/vectors.hpp"
#include "witmotion_wire.hpp"

namespace picolo::test {
namespace {

std::vector<Bytes> decode(WitMotionDecoder& decoder, const Bytes& stream) {
  std::vector<Bytes> frames;
  for (const std::uint8_t byte : stream) {
    if (!is_ok(decoder.push(byte))) { continue; }
    const auto& words = decoder.frame().words;
    frames.push_back(wire_frame(static_cast<std::uint8_t>(decoder.frame().type),
                                {words[0], words[1], words[2], words[3]}));
  }
  return frames;
}

std::vector<Bytes> decode(const Bytes& stream) {
  WitMotionDecoder decoder;
  return decode(decoder, stream);
}

/// Full of false headers; chosen so that no false candidate has the right sum by chance (odds 1 in
/// 256 each).
std::vector<Bytes> three_frames() {
  return {wire_frame(0x51, {0x5551, 0x5152, 0x5255, 0x5055}),
          wire_frame(0x52, {-1, 32767, -32768, 0x5A54}),
          wire_frame(0x53, {0x5555, 0x5555, 0x5555, 0x5555})};
}

Bytes joined(const std::vector<Bytes>& frames) {
  Bytes all;
  for (const Bytes& frame : frames) { all = join({all, frame}); }
  return all;
}

std::vector<Bytes> without(std::vector<Bytes> frames, std::size_t index) {
  frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(index));
  return frames;
}

TEST(WitMotionFrame, GivenRecordedStreamsThenEveryFrameIsDecodedAsPublishedInAnyCut) {
  PICOLO_NEED_DATA(kVectorFile);
  const auto vectors = byte_vectors("WitMotion standard");
  ASSERT_GE(vectors.size(), 3U);
  for (const ByteVector& vector : vectors) {
    SCOPED_TRACE(vector.id);
    const auto& frames = vector.expected.at("frames");
    ASSERT_EQ(frames.size(), vector.expected.at("valid_frames").get<std::size_t>());
    WitMotionDecoder decoder;
    std::size_t found = 0;
    std::size_t offset = 0;
    for (const std::uint8_t byte : vector.bytes) {
      ++offset;
      if (!is_ok(decoder.push(byte))) { continue; }
      ASSERT_LT(found, frames.size());
      EXPECT_EQ(offset - kWitMotionFrameSize, frames[found].at("offset").get<std::size_t>());
      EXPECT_EQ(static_cast<int>(decoder.frame().type),
                std::stoi(frames[found].at("type").get<std::string>(), nullptr, 16));
      EXPECT_EQ(decoder.frame().words,
                (frames[found].at("raw").get<std::array<std::int16_t, 4>>()));
      ++found;
    }
    EXPECT_EQ(found, frames.size());
    EXPECT_EQ(decoder.counters().skipped_bytes, vector.bytes.size() - found * kWitMotionFrameSize);
  }
}

TEST(WitMotionFrame, GivenAnySingleBitFlippedInThreeFramesThenOnlyTheDamagedOneIsLost) {
  const std::vector<Bytes> frames = three_frames();
  const Bytes stream = joined(frames);
  for (std::size_t bit = 0; bit < stream.size() * 8; ++bit) {
    ASSERT_EQ(decode(with_bit_flipped(stream, bit)), without(frames, bit / 8 / kWitMotionFrameSize))
        << "bit " << bit;
  }
}

TEST(WitMotionFrame, GivenAnyByteLostThenNoFollowingFrameIsLost) {
  const std::vector<Bytes> frames = three_frames();
  const Bytes stream = joined(frames);
  for (std::size_t at = 0; at < stream.size(); ++at) {
    ASSERT_EQ(decode(without_byte(stream, at)), without(frames, at / kWitMotionFrameSize))
        << "byte " << at;
  }
}

TEST(WitMotionFrame, GivenAnyByteInsertedThenNoFollowingFrameIsLost) {
  const std::vector<Bytes> frames{wire_frame(0x51, {1, 2, 3, 4}), wire_frame(0x52, {5, 6, 7, 8}),
                                  wire_frame(0x53, {9, 10, 11, 12})};
  const Bytes stream = joined(frames);
  for (std::size_t at = 0; at < stream.size(); ++at) {
    for (const std::uint8_t byte : {std::uint8_t{0x55}, std::uint8_t{0xA0}}) {
      const auto found = decode(with_byte(stream, at, byte));
      ASSERT_TRUE(found == frames || found == without(frames, at / kWitMotionFrameSize))
          << "byte " << at;
      if (at % kWitMotionFrameSize == 0) { ASSERT_EQ(found, frames) << "byte " << at; }
    }
  }
}

TEST(WitMotionFrame, GivenATerminalInCanonicalModeThatSwallowsControlDThenFramesWithoutItSurvive) {
  const std::vector<Bytes> frames{wire_frame(0x51, {1, 2, 3, 5}), wire_frame(0x52, {4, 0, 0, 9}),
                                  wire_frame(0x53, {7, 8, 9, 10})};
  Bytes stream = joined(frames);
  std::erase(stream, std::uint8_t{0x04});
  ASSERT_EQ(stream.size(), 32U);
  EXPECT_EQ(decode(stream), without(frames, 1));
}

TEST(WitMotionFrame, GivenHeadersBeforeAFrameThenTheFrameIsFound) {
  const Bytes frame = wire_frame(0x52, {1, 2, 3, 4});
  for (const Bytes& prefix :
       {Bytes{0x55}, Bytes{0x55, 0x55}, Bytes{0x55, 0x51}, Bytes{0x55, 0x60}, Bytes{0x50, 0x55}}) {
    EXPECT_THAT(decode(join({prefix, frame, frame})), testing::ElementsAre(frame, frame));
  }
}

TEST(WitMotionFrame, GivenOtherTypesThenOnlyThoseOfTheProtocolAreFrames) {
  EXPECT_EQ(decode(wire_frame(0x5F, {1, 2, 3, 4})).size(), 1U);
  EXPECT_EQ(decode(wire_frame(0x4F, {1, 2, 3, 4})).size(), 0U);
  EXPECT_EQ(decode(wire_frame(0x61, {1, 2, 3, 4})).size(), 0U);
}

TEST(WitMotionFrame, GivenTwoDecodersFedInTurnsThenNeitherDisturbsTheOther) {
  WitMotionDecoder a;
  WitMotionDecoder b;
  const Bytes first = joined(three_frames());
  const Bytes second = join({wire_group(100)});
  std::size_t from_a = 0;
  std::size_t from_b = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    from_a += is_ok(a.push(first[i])) ? 1U : 0U;
    from_b += is_ok(b.push(second[i])) ? 1U : 0U;
  }
  EXPECT_EQ(from_a, 3U);
  EXPECT_EQ(from_b, 3U);
}

TEST(WitMotionFrame, GivenNoiseThenTheNextFrameIsFoundAtOnce) {
  WitMotionDecoder decoder;
  static_cast<void>(decode(decoder, noise(1'000'000, 5)));
  // Odds of a false frame: 2^-20 a byte.
  EXPECT_LE(decoder.counters().frames, 5U);
  decoder.reset();
  EXPECT_EQ(decoder.pending(), 0U);
  const Bytes frame = wire_frame(0x51, {1, 2, 3, 4});
  EXPECT_THAT(decode(decoder, frame), testing::ElementsAre(frame));
}

TEST(WitMotionFrame, PropertyWhatAnEncoderWritesIsWhatComesOut) {
  EXPECT_TRUE(rc::check([] {
    const auto type = *rc::gen::inRange<std::uint8_t>(0x50, 0x60);
    const auto words =
        *rc::gen::container<std::array<std::int16_t, 4>>(rc::gen::arbitrary<std::int16_t>());
    const Bytes bytes = wire_frame(type, {words[0], words[1], words[2], words[3]});
    RC_ASSERT(decode(bytes) == std::vector<Bytes>{bytes});
  }));
}

}  // namespace
}  // namespace picolo::test
