// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Checksums of the supported wires and of stored records. Table-free: bit by bit is fast enough
/// for serial lines.
#pragma once

#include <cstdint>
#include <span>

namespace picolo::inline v0 {

/// CRC-8, most significant bit first, no reflection, no final exclusive-or. LD06: polynomial 0x4D,
/// start 0.
/// Cost: O(bytes). Context: any.
[[nodiscard]] std::uint8_t crc8(std::span<const std::uint8_t> bytes, std::uint8_t polynomial,
                                std::uint8_t start = 0);
/// CRC-16-CCITT: polynomial 0x1021, most significant bit first. VectorNav: start 0.
[[nodiscard]] std::uint16_t crc16_ccitt(std::span<const std::uint8_t> bytes,
                                        std::uint16_t start = 0);
/// CRC-32 (IEEE 802.3, reflected, as zlib's crc32). Pass the previous result to continue.
[[nodiscard]] std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t previous = 0);
/// Sum of all bytes modulo 256.
[[nodiscard]] std::uint8_t sum8(std::span<const std::uint8_t> bytes);
/// Exclusive-or of all bytes.
[[nodiscard]] std::uint8_t xor8(std::span<const std::uint8_t> bytes);

}  // namespace picolo::inline v0
