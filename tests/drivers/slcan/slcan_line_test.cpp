// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/slcan/slcan_line.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/property.hpp"
#include "support/slcan_adapter.hpp"

namespace picolo::slcan {
namespace {

std::string text_of(const CanFrame& frame) {
  const Line line = encode(frame);
  return {line.view().begin(), line.view().end()};
}

Result<CanFrame> frame_of(const std::string& text) {
  return decode(std::vector<std::uint8_t>(text.begin(), text.end()));
}

// Lines of the CANUSB manual and of candump through slcand.
TEST(SlcanLine, WritesThePublishedForms) {
  EXPECT_EQ(text_of({.id = 0x100, .length = 0}), "t1000");
  EXPECT_EQ(text_of({.id = 0x7FF, .length = 2, .data = {0x1A, 0x0F}}), "t7FF21A0F");
  EXPECT_EQ(text_of({.id = 0x100, .extended = true, .length = 1, .data = {0x33}}), "T00000100133");
  EXPECT_EQ(text_of({.id = 0x1AB, .remote = true, .length = 4}), "r1AB4");
}

TEST(SlcanLine, ReadsSmallLettersAndTheAdaptersTime) {
  const Result<CanFrame> frame = frame_of("t1ab2cdEF1234");
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, 0x1ABU);
  EXPECT_EQ(frame->length, 2U);
  EXPECT_EQ(frame->data[1], 0xEFU);
}

TEST(SlcanLine, TellsAnswersFromDamage) {
  for (const char* answer : {"", "z", "Z", "V1013", "NA123", "F00"}) {
    EXPECT_EQ(frame_of(answer).status(), Status::not_ready) << answer;
  }
  for (const char* damage : {"t", "t12", "t123", "t1239", "t12G0", "t123100zz", "t800",
                             "T200000000", "t123211223344556", "r12341", "Q"}) {
    EXPECT_EQ(frame_of(damage).status(), Status::invalid_argument) << damage;
  }
}

RC_GTEST_PROP(SlcanLine, EveryFrameComesBack, ()) {
  CanFrame frame{.extended = *rc::gen::arbitrary<bool>(), .remote = *rc::gen::arbitrary<bool>()};
  frame.id = *rc::gen::inRange<std::uint32_t>(0, frame.extended ? 0x2000'0000U : 0x800U);
  frame.length = *rc::gen::inRange<std::uint8_t>(0, 9);
  for (std::size_t i = 0; i < frame.length && !frame.remote; ++i) {
    frame.data[i] = *rc::gen::arbitrary<std::uint8_t>();
  }
  const Result<CanFrame> back = frame_of(text_of(frame));
  RC_ASSERT(static_cast<bool>(back));
  RC_ASSERT(back->id == frame.id && back->extended == frame.extended &&
            back->remote == frame.remote && back->length == frame.length &&
            back->data == frame.data);
}

RC_GTEST_PROP(SlcanLine, AnyBytesGiveNoImpossibleFrame, (const std::string& text)) {
  const Result<CanFrame> frame = frame_of("t" + text);
  RC_ASSERT(!frame || (frame->length <= 8 && frame->id <= 0x7FF));
}

}  // namespace
}  // namespace picolo::slcan
