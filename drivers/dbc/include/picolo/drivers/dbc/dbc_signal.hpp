// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One signal of a CAN database: where its bits lie and what they mean. Pure, table-driven.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"

namespace picolo::inline v0 {

enum class DbcType : std::uint8_t { unsigned_integer, signed_integer, float32, float64 };

/// Bits as the DBC format counts them: bit b is bit b % 8 of byte b / 8. Little-endian signals
/// start at their least significant bit, big-endian ones (Motorola) at their most significant.
struct DbcSignal {
  std::uint8_t start_bit = 0;
  std::uint8_t length = 0;  ///< 1 to 64
  bool big_endian = false;
  DbcType type = DbcType::unsigned_integer;
  /// This raw value means "not known". With has_invalid.
  std::uint64_t invalid_raw = 0;
  bool has_invalid = false;

  /// Shorter frames do not carry the signal. Bytes.
  [[nodiscard]] constexpr std::size_t needed_bytes() const {
    if (!big_endian) { return (std::size_t{start_bit} + length + 7) / 8; }
    const std::size_t down = start_bit % 8 + std::size_t{1};  // bits of the first byte
    const std::size_t rest = length > down ? length - down : 0;
    return start_bit / 8 + 1 + (rest + 7) / 8;
  }
  /// Lies inside of a frame of `frame_bytes`, and a float has a float's length.
  [[nodiscard]] constexpr bool valid(std::size_t frame_bytes) const {
    const bool size = length >= 1 && length <= 64 && start_bit < 64;
    const bool number =
        (type != DbcType::float32 || length == 32) && (type != DbcType::float64 || length == 64);
    return size && number && frame_bytes <= 8 && needed_bytes() <= frame_bytes;
  }
};

/// The signal's bits, least significant first. `out_of_range`: the frame is too short.
/// Precondition: signal.valid(8). Cost: O(bytes). Context: any.
[[nodiscard]] Result<std::uint64_t> dbc_raw(const DbcSignal& signal, ByteView data);
/// The same with its sign. `not_ready`: the raw value means "not known"; `unsupported`: a float.
[[nodiscard]] Result<std::int64_t> dbc_integer(const DbcSignal& signal, ByteView data);
/// Integers and floats as float, before factor and offset. `corrupt`: NaN or infinity.
[[nodiscard]] Result<float> dbc_number(const DbcSignal& signal, ByteView data);

static_assert(DbcSignal{.start_bit = 7, .length = 16, .big_endian = true}.needed_bytes() == 2);
static_assert(DbcSignal{.start_bit = 8, .length = 15, .big_endian = true}.needed_bytes() == 4);

/// A signal that is in the frame only when another one has a certain value.
struct DbcMultiplexer {
  DbcSignal selector{};
  std::uint64_t value = 0;
  bool used = false;
};

/// How a message protects itself.
enum class DbcChecksum : std::uint8_t {
  none,
  /// Sum of all other bytes and of the identifier's bytes (Nissan, Toyota without length).
  sum_with_id,
  exclusive_or,  ///< of all other bytes
  crc8,          ///< of all other bytes, last first: polynomial 0xD5, start 0xFF (comma body)
};

struct DbcRules {
  DbcChecksum checksum = DbcChecksum::none;
  std::uint8_t checksum_byte = 7;
  DbcSignal counter{};  ///< length 0 = none
  [[nodiscard]] constexpr bool valid(std::size_t frame_bytes) const {
    return (checksum == DbcChecksum::none || checksum_byte < frame_bytes) &&
           (counter.length == 0 || (counter.length <= 16 && counter.valid(frame_bytes)));
  }
};

/// `checksum`: it is wrong. `ok` where there is none.
[[nodiscard]] Status dbc_check(const DbcRules& rules, std::uint32_t id, ByteView data);

}  // namespace picolo::inline v0
