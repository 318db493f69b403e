// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/core/crc.hpp"

namespace picolo::inline v0 {

std::uint8_t crc8(std::span<const std::uint8_t> bytes, std::uint8_t polynomial,
                  std::uint8_t start) {
  std::uint32_t crc = start;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 0x80U) != 0 ? ((crc << 1) ^ polynomial) & 0xFFU : (crc << 1) & 0xFFU;
    }
  }
  return static_cast<std::uint8_t>(crc);
}

std::uint16_t crc16_ccitt(std::span<const std::uint8_t> bytes, std::uint16_t start) {
  std::uint32_t crc = start;
  for (const std::uint8_t byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte) << 8;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 0x8000U) != 0 ? ((crc << 1) ^ 0x1021U) & 0xFFFFU : (crc << 1) & 0xFFFFU;
    }
  }
  return static_cast<std::uint16_t>(crc);
}

std::uint32_t crc32(std::span<const std::uint8_t> bytes, std::uint32_t previous) {
  std::uint32_t crc = ~previous;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 1U) != 0 ? (crc >> 1) ^ 0xEDB88320U : crc >> 1;
    }
  }
  return ~crc;
}

std::uint8_t sum8(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0;
  for (const std::uint8_t byte : bytes) { sum += byte; }
  return static_cast<std::uint8_t>(sum & 0xFFU);
}

std::uint8_t xor8(std::span<const std::uint8_t> bytes) {
  std::uint8_t all = 0;
  for (const std::uint8_t byte : bytes) { all = static_cast<std::uint8_t>(all ^ byte); }
  return all;
}

}  // namespace picolo::inline v0
