// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The bytes of the manuals.

#include <gtest/gtest.h>

#include <array>

#include "picolo/sim/ld06_wire.hpp"
#include "picolo/sim/witmotion_wire.hpp"

namespace picolo::sim {
namespace {

TEST(Ld06Wire, GivenTheExampleOfTheManualThenItsBytes) {
  const Ld06Packet packet{.speed_dps = 2152,
                          .start_cdeg = 32'427,
                          .end_cdeg = 33'470,
                          .range_mm = {224, 220, 217, 213, 211, 208, 205, 202, 199, 197, 194, 192},
                          .intensity = {228, 226, 229, 227, 228, 233, 228, 226, 233, 229, 229, 229},
                          .stamp_ms = 6714};
  constexpr std::array<std::uint8_t, kLd06PacketSize> kManual{
      0x54, 0x2C, 0x68, 0x08, 0xAB, 0x7E, 0xE0, 0x00, 0xE4, 0xDC, 0x00, 0xE2,
      0xD9, 0x00, 0xE5, 0xD5, 0x00, 0xE3, 0xD3, 0x00, 0xE4, 0xD0, 0x00, 0xE9,
      0xCD, 0x00, 0xE4, 0xCA, 0x00, 0xE2, 0xC7, 0x00, 0xE9, 0xC5, 0x00, 0xE5,
      0xC2, 0x00, 0xE5, 0xC0, 0x00, 0xE5, 0xBE, 0x82, 0x3A, 0x1A, 0x50};
  EXPECT_EQ(encode(packet), kManual);
}

TEST(WitMotionWire, GivenWordsThenLittleEndianAndTheSumOfTheFirstTen) {
  const auto bytes = encode({.type = kWitMotionRate, .words = {0x0102, -1, 0, -32'768}});
  constexpr std::array<std::uint8_t, kWitMotionFrameSize> kExpected{
      0x55, 0x52, 0x02, 0x01, 0xFF, 0xFF, 0x00, 0x00, 0x00, 0x80, 0x28};
  EXPECT_EQ(bytes, kExpected);
}

}  // namespace
}  // namespace picolo::sim
