// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a process data object carries: a list of objects packed from bit 0 on, least significant
/// bit first (CiA 301).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"

namespace picolo::inline v0::canopen {

/// Objects of interest.
inline constexpr std::uint16_t kPositionActual402 = 0x6064;  ///< i32, CiA 402
inline constexpr std::uint16_t kVelocityActual402 = 0x606C;  ///< i32, CiA 402, unit by vendor
inline constexpr std::uint16_t kPosition406 = 0x6004;  ///< u32, CiA 406, wraps at object 0x6002
inline constexpr std::uint16_t kSpeed406 = 0x6030;     ///< i16, CiA 406

/// One entry of a mapping record (0x1A00 to 0x1BFF): index << 16 | subindex << 8 | bits.
struct MappedObject {
  std::uint16_t index = 0;
  std::uint8_t subindex = 0;
  std::uint8_t bits = 0;  ///< 0 ends the list
  friend constexpr bool operator==(const MappedObject&, const MappedObject&) = default;
};

/// From the word that a drive stores in its mapping record.
[[nodiscard]] constexpr MappedObject mapped_object(std::uint32_t entry) {
  return {static_cast<std::uint16_t>(entry >> 16), static_cast<std::uint8_t>((entry >> 8) & 0xFFU),
          static_cast<std::uint8_t>(entry & 0xFFU)};
}

/// The whole record; entries after the first with 0 bits do not count.
using PdoMapping = std::array<MappedObject, 8>;

/// Where one object lies inside of the payload.
struct PdoField {
  std::uint8_t first_bit = 0;
  std::uint8_t bits = 0;
};

[[nodiscard]] constexpr unsigned total_bits(const PdoMapping& mapping) {
  unsigned bits = 0;
  for (const MappedObject& object : mapping) {
    if (object.bits == 0) { break; }
    bits += object.bits;
  }
  return bits;
}

/// Bytes a frame must have at least to carry the mapping.
[[nodiscard]] constexpr std::size_t total_bytes(const PdoMapping& mapping) {
  return (total_bits(mapping) + 7) / 8;
}

/// `out_of_range`: the mapping does not carry this object, or not within 64 bits.
[[nodiscard]] constexpr Result<PdoField> find_field(const PdoMapping& mapping, std::uint16_t index,
                                                    std::uint8_t subindex) {
  unsigned first_bit = 0;
  for (const MappedObject& object : mapping) {
    if (object.bits == 0 || first_bit + object.bits > 64) { break; }
    if (object.index == index && object.subindex == subindex) {
      return PdoField{static_cast<std::uint8_t>(first_bit), object.bits};
    }
    first_bit += object.bits;
  }
  return Status::out_of_range;
}

/// The field's bits as an unsigned number. Precondition: the data holds the field; 1 <= bits <= 64.
[[nodiscard]] constexpr std::uint64_t extract(ByteView data, PdoField field) {
  std::uint64_t word = 0;
  for (std::size_t i = 0; i < data.size() && i < 8; ++i) {
    word |= static_cast<std::uint64_t>(data[i]) << (8 * i);
  }
  word >>= field.first_bit;
  return field.bits >= 64 ? word : word & ((std::uint64_t{1} << field.bits) - 1);
}

/// The same bits as a two's complement number.
[[nodiscard]] constexpr std::int64_t extract_signed(ByteView data, PdoField field) {
  const unsigned unused = 64U - field.bits;
  return std::bit_cast<std::int64_t>(extract(data, field) << unused) >> unused;
}

}  // namespace picolo::inline v0::canopen
