// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/canopen/pdo_mapping.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "picolo/core/bytes.hpp"
#include "support/property.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

using canopen::extract;
using canopen::extract_signed;
using canopen::find_field;
using canopen::mapped_object;
using canopen::MappedObject;
using canopen::PdoField;
using canopen::PdoMapping;

constexpr PdoMapping kPositionBehindStatus{{{0x6041, 0, 16}, {0x6064, 0, 32}, {0x6061, 0, 8}}};
static_assert(find_field(kPositionBehindStatus, 0x6064, 0)->first_bit == 16);
static_assert(canopen::total_bits(kPositionBehindStatus) == 56);
static_assert(canopen::total_bytes(kPositionBehindStatus) == 7);
static_assert(find_field(kPositionBehindStatus, 0x606C, 0).status() == Status::out_of_range);
static_assert(find_field(kPositionBehindStatus, 0x6064, 1).status() == Status::out_of_range);

TEST(PdoMapping, GivenTheRecordedMappingOfADriveThenItsObjectsAreFound) {
  PICOLO_NEED_DATA("drivers/can/canopen_navican_cia402.candump");
  PdoMapping mapping{};
  for (const CanFrame& frame :
       read_candump(data_path("drivers/can/canopen_navican_cia402.candump"))) {
    // SDO write of 0x1A01:01 and :02 to node 2
    const bool writes_mapping =
        frame.id == 0x602 && frame.data[0] == 0x23 && load_u16_le(frame.data, 1) == 0x1A01;
    if (writes_mapping) {
      mapping.at(frame.data[3] - 1U) = mapped_object(load_u32_le(frame.data, 4));
    }
  }
  EXPECT_EQ(mapping[0], (MappedObject{canopen::kVelocityActual402, 0, 32}));
  EXPECT_EQ(mapping[1], (MappedObject{canopen::kPositionActual402, 0, 32}));
  EXPECT_EQ(find_field(mapping, canopen::kPositionActual402, 0)->first_bit, 32);
  EXPECT_EQ(canopen::total_bytes(mapping), 8U);
}

TEST(PdoMapping, GivenAnObjectThatEndsBeyondEightBytesThenItIsNotFound) {
  constexpr PdoMapping kTooLong{{{0x2000, 0, 40}, {0x6064, 0, 32}}};
  EXPECT_EQ(find_field(kTooLong, 0x6064, 0).status(), Status::out_of_range);
  EXPECT_TRUE(find_field(kTooLong, 0x2000, 0));
}

TEST(PdoMapping, GivenAnEntryWithoutBitsThenTheListEndsThere) {
  constexpr PdoMapping kEnded{{{0x6041, 0, 16}, {0x6060, 0, 0}, {0x6064, 0, 32}}};
  EXPECT_EQ(find_field(kEnded, 0x6064, 0).status(), Status::out_of_range);
  EXPECT_EQ(canopen::total_bits(kEnded), 16U);
}

TEST(PdoMapping, GivenNegativeNumbersThenTheSignIsExtended) {
  const Bytes data = from_hex("FEFFFFFF 00000080");
  EXPECT_EQ(extract_signed(data, {0, 32}), -2);
  EXPECT_EQ(extract(data, {0, 32}), 0xFFFFFFFEU);
  EXPECT_EQ(extract_signed(data, {32, 32}), INT32_MIN);
  EXPECT_EQ(extract_signed(data, {0, 64}), INT64_MIN + 0xFFFFFFFELL);
  EXPECT_EQ(extract(data, {0, 64}), 0x80000000FFFFFFFEULL);
}

TEST(PdoMapping, PropertyExtractAgreesWithReadingBitByBit) {
  EXPECT_TRUE(rc::check([] {
    const auto data = *rc::gen::container<Bytes>(8, rc::gen::arbitrary<std::uint8_t>());
    const auto bits = *rc::gen::inRange<std::uint8_t>(1, 65);
    const auto first = *rc::gen::inRange<std::uint8_t>(0, static_cast<std::uint8_t>(65 - bits));
    std::uint64_t expected = 0;
    for (unsigned i = 0; i < bits; ++i) {
      const unsigned at = first + i;
      const std::uint64_t byte = data[at / 8];
      expected |= ((byte >> (at % 8)) & 1U) << i;
    }
    const PdoField field{first, bits};
    RC_ASSERT(extract(data, field) == expected);
    const bool negative = ((expected >> (bits - 1U)) & 1U) != 0;
    const std::uint64_t above = bits == 64 ? 0 : ~std::uint64_t{0} << bits;
    RC_ASSERT(static_cast<std::uint64_t>(extract_signed(data, field)) ==
              (negative ? expected | above : expected));
  }));
}

}  // namespace
}  // namespace picolo::test
