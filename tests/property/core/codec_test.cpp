// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Bytes, checksums and hashes: round trips, residues, independence of how the bytes were cut.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/core/hash.hpp"
#include "support/property.hpp"

namespace picolo {
namespace {

using Bytes = std::vector<std::uint8_t>;

RC_GTEST_PROP(BytesLaws, StoreThenLoadIsIdentity, (std::uint32_t value, std::uint8_t filler)) {
  std::array<std::uint8_t, 8> bytes{};
  bytes.fill(filler);
  const auto offset = *rc::gen::inRange<std::size_t>(0, 5);
  store_u32_le(bytes, offset, value);
  RC_ASSERT(load_u32_le(bytes, offset) == value);
  RC_ASSERT(std::bit_cast<std::uint32_t>(load_i32_le(bytes, offset)) == value);
  RC_ASSERT(load_u16_le(bytes, offset) == (value & 0xFFFFU));
  RC_ASSERT(load_u16_le(bytes, offset + 2) == value >> 16);
}

RC_GTEST_PROP(BytesLaws, BigEndianIsLittleEndianOfTheMirroredBytes,
              (const std::array<std::uint8_t, 4>& bytes)) {
  const std::array<std::uint8_t, 4> mirrored{bytes[3], bytes[2], bytes[1], bytes[0]};
  RC_ASSERT(load_u32_be(bytes, 0) == load_u32_le(mirrored, 0));
  RC_ASSERT(load_i32_be(bytes, 0) == load_i32_le(mirrored, 0));
  RC_ASSERT(load_u16_be(bytes, 1) == load_u16_le(mirrored, 1));
}

RC_GTEST_PROP(CounterLaws, AnyStepUnderHalfATurnIsFoundAgain, (std::uint32_t start)) {
  const auto modulus = *rc::gen::inRange<std::uint64_t>(2, (std::uint64_t{1} << 32) + 1);
  const std::uint64_t before = start % modulus;
  const auto half = static_cast<std::int64_t>(modulus / 2);
  const auto step = *rc::gen::inRange<std::int64_t>(-half + 1, half);
  const auto range = static_cast<std::int64_t>(modulus);
  const auto now =
      static_cast<std::uint64_t>((static_cast<std::int64_t>(before) + step + range) % range);
  RC_ASSERT(wrapped_difference(static_cast<std::uint32_t>(now), static_cast<std::uint32_t>(before),
                               modulus) == step);
}

RC_GTEST_PROP(CrcLaws, AMessageFollowedByItsChecksumHasResidueZero, (Bytes message)) {
  const auto polynomial = *rc::gen::element<std::uint8_t>(0x4D, 0x07, 0x31, 0x2F);
  Bytes with_crc8 = message;
  with_crc8.push_back(crc8(message, polynomial));
  RC_ASSERT(crc8(with_crc8, polynomial) == 0);

  const std::uint16_t crc = crc16_ccitt(message);
  message.push_back(static_cast<std::uint8_t>(crc >> 8));
  message.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  RC_ASSERT(crc16_ccitt(message) == 0);
}

RC_GTEST_PROP(CrcLaws, ABurstUpToTheWidthOfTheChecksumIsSeen, (Bytes message)) {
  RC_PRE(message.size() >= 5U);
  const std::uint16_t before16 = crc16_ccitt(message);
  const std::uint32_t before32 = crc32(message);
  const auto at = *rc::gen::inRange<std::size_t>(0, message.size() - 1);
  const auto burst = *rc::gen::inRange<std::uint32_t>(1, 0x10000);
  message[at] = static_cast<std::uint8_t>(message[at] ^ (burst & 0xFFU));
  message[at + 1] = static_cast<std::uint8_t>(message[at + 1] ^ (burst >> 8));
  RC_ASSERT(crc16_ccitt(message) != before16);
  RC_ASSERT(crc32(message) != before32);
}

RC_GTEST_PROP(CutLaws, HashAndCrcDoNotDependOnWhereTheBytesWereCut, (const Bytes& bytes)) {
  const auto cut = *rc::gen::inRange<std::size_t>(0, bytes.size() + 1);
  const std::span<const std::uint8_t> whole{bytes};
  Hash once;
  once.add_bytes(whole);
  Hash twice;
  twice.add_bytes(whole.first(cut));
  twice.add_bytes(whole.subspan(cut));
  RC_ASSERT(once.value() == twice.value());
  RC_ASSERT(crc32(whole.subspan(cut), crc32(whole.first(cut))) == crc32(whole));
  RC_ASSERT(static_cast<std::uint8_t>(sum8(whole.first(cut)) + sum8(whole.subspan(cut))) ==
            sum8(whole));
  RC_ASSERT((xor8(whole.first(cut)) ^ xor8(whole.subspan(cut))) == xor8(whole));
}

}  // namespace
}  // namespace picolo
