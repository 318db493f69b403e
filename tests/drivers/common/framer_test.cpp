// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/framer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "support/bytes.hpp"
#include "support/property.hpp"

namespace picolo::test {
namespace {

/// A toy of variable length: AA, size of the payload (at most 5), payload, sum. A payload that
/// begins with FF is implausible.
struct ToyFormat {
  static constexpr std::size_t kMaxFrame = 8;
  [[nodiscard]] FrameCheck check(ByteView bytes) const {
    if (bytes[0] != 0xAA || (bytes.size() > 1 && bytes[1] > 5)) {
      return {FrameVerdict::no_header};
    }
    if (bytes.size() < 2 || bytes.size() < bytes[1] + 3U) { return {FrameVerdict::incomplete}; }
    const std::size_t size = bytes[1] + 3U;
    const unsigned sum =
        std::accumulate(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size) - 1, 0U);
    if (sum % 256 != bytes[size - 1]) { return {FrameVerdict::checksum}; }
    if (size > 3 && bytes[2] == 0xFF) { return {FrameVerdict::implausible}; }
    return {FrameVerdict::complete, size};
  }
};

Bytes toy(Bytes payload) {
  Bytes frame = join({{0xAA, static_cast<std::uint8_t>(payload.size())}, payload});
  frame.push_back(static_cast<std::uint8_t>(std::accumulate(frame.begin(), frame.end(), 0U) % 256));
  return frame;
}

std::vector<Bytes> frames_of(Framer<ToyFormat>& framer, const Bytes& stream) {
  std::vector<Bytes> frames;
  for (const std::uint8_t byte : stream) {
    framer.push(byte);
    while (framer.next()) { frames.emplace_back(framer.frame().begin(), framer.frame().end()); }
  }
  return frames;
}

struct TwoBytes {
  static constexpr std::size_t kMaxFrame = 2;
  [[nodiscard]] constexpr FrameCheck check(ByteView bytes) const {
    return bytes.size() < 2 ? FrameCheck{} : FrameCheck{FrameVerdict::complete, 2};
  }
};

constexpr std::uint32_t frames_of_a_constant_stream() {
  Framer<TwoBytes> framer;
  for (int byte = 0; byte < 6; ++byte) {
    framer.push(0);
    (void)framer.next();
  }
  return framer.counters().frames;
}
// A constant expression cannot write past the window: frames that fill it, one after the other.
static_assert(frames_of_a_constant_stream() == 3);

TEST(Framer, GivenSeveralFramesHiddenBehindARejectedCandidateThenAllAreFoundInOrder) {
  Framer<ToyFormat> framer;
  const Bytes small = toy({});
  // AA 05 claims five bytes of payload, which are two whole frames of three bytes and no sum that
  // fits.
  const Bytes stream = join({{0xAA, 0x05}, small, small});
  for (std::size_t i = 0; i + 1 < stream.size(); ++i) {
    framer.push(stream[i]);
    ASSERT_FALSE(framer.next());
  }
  framer.push(stream.back());
  ASSERT_TRUE(framer.next());
  EXPECT_EQ(framer.frame().size(), 3U);
  EXPECT_EQ(framer.bytes_after_frame(), 3U);
  ASSERT_TRUE(framer.next());
  EXPECT_EQ(framer.bytes_after_frame(), 0U);
  EXPECT_FALSE(framer.next());
  EXPECT_EQ(framer.counters().frames, 2U);
  EXPECT_EQ(framer.counters().bad_checksums, 1U);
  EXPECT_EQ(framer.counters().skipped_bytes, 2U);
}

TEST(Framer, GivenASoundButImpossibleFrameThenItIsCountedAsSuch) {
  Framer<ToyFormat> framer;
  EXPECT_TRUE(frames_of(framer, toy({0xFF, 1})).empty());
  EXPECT_EQ(framer.counters().implausible, 1U);
  EXPECT_EQ(framer.counters().bad_checksums, 0U);
}

TEST(Framer, GivenAResetThenTheBeginningOfAFrameIsForgotten) {
  Framer<ToyFormat> framer;
  const Bytes frame = toy({1, 2, 3});
  static_cast<void>(frames_of(framer, {frame.begin(), frame.begin() + 4}));
  EXPECT_EQ(framer.pending(), 4U);
  framer.reset();
  EXPECT_EQ(framer.pending(), 0U);
  EXPECT_THAT(frames_of(framer, frame), testing::ElementsAre(frame));
}

/// Answers "more" for ever, against the contract.
struct EndlessFormat {
  static constexpr std::size_t kMaxFrame = 4;
  [[nodiscard]] FrameCheck check(ByteView /*bytes*/) const { return {FrameVerdict::incomplete}; }
};

TEST(Framer, GivenAFormatThatNeverDecidesThenTheWindowDoesNotOverflow) {
  Framer<EndlessFormat> framer;
  for (int i = 0; i < 100; ++i) {
    framer.push(0);
    ASSERT_FALSE(framer.next());
    ASSERT_LT(framer.pending(), 4U);
  }
  EXPECT_EQ(framer.counters().skipped_bytes, 97U);
}

TEST(Framer, PropertyEveryByteIsEitherInAFrameOrSkippedOrPending) {
  EXPECT_TRUE(rc::check([] {
    const auto stream = *rc::gen::container<Bytes>(
        rc::gen::element<std::uint8_t>(0xAA, 0, 1, 2, 3, 0xAB, 0xAC, 0xFF));
    Framer<ToyFormat> framer;
    std::size_t in_frames = 0;
    for (const Bytes& frame : frames_of(framer, stream)) { in_frames += frame.size(); }
    RC_ASSERT(in_frames + framer.counters().skipped_bytes + framer.pending() == stream.size());
  }));
}

TEST(Framer, PropertyGarbageThatHoldsNoHeaderNeverCostsAFrame) {
  EXPECT_TRUE(rc::check([] {
    const auto payloads =
        *rc::gen::container<std::vector<std::uint8_t>>(rc::gen::inRange<std::uint8_t>(0, 0xAA));
    Bytes stream;
    std::vector<Bytes> expected;
    for (const std::uint8_t payload : payloads) {
      expected.push_back(toy({payload, 0xAA, 0x01}));
      stream = join({stream, Bytes(payload % 4U, payload), expected.back()});
    }
    Framer<ToyFormat> framer;
    RC_ASSERT(frames_of(framer, stream) == expected);
  }));
}

}  // namespace
}  // namespace picolo::test
