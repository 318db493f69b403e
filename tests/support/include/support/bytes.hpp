// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Byte streams in tests: hexadecimal text, ways to cut a stream, ways to damage it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "picolo/core/random.hpp"

namespace picolo::test {

using Bytes = std::vector<std::uint8_t>;

/// "55 51 9F" or "55519F"; anything that is no hexadecimal digit is skipped.
inline Bytes from_hex(std::string_view text) {
  Bytes bytes;
  int high = -1;
  for (const char c : text) {
    const std::string_view digits = "0123456789abcdef";
    const std::size_t digit = digits.find(c >= 'A' && c <= 'F' ? static_cast<char>(c + 32) : c);
    if (digit == std::string_view::npos) { continue; }
    if (high < 0) {
      high = static_cast<int>(digit);
      continue;
    }
    bytes.push_back(static_cast<std::uint8_t>(high * 16 + static_cast<int>(digit)));
    high = -1;
  }
  return bytes;
}

inline Bytes join(std::initializer_list<Bytes> parts) {
  Bytes all;
  for (const Bytes& part : parts) { all.insert(all.end(), part.begin(), part.end()); }
  return all;
}

/// Pieces of 1 to `longest` bytes, the same for the same seed.
inline std::vector<Bytes> cut_randomly(const Bytes& stream, std::size_t longest,
                                       std::uint64_t seed) {
  Random random{seed};
  std::vector<Bytes> pieces;
  for (std::size_t at = 0; at < stream.size();) {
    const std::size_t wish = 1 + random.below(static_cast<std::uint32_t>(longest));
    const std::size_t end = std::min(stream.size(), at + wish);
    pieces.emplace_back(stream.begin() + static_cast<std::ptrdiff_t>(at),
                        stream.begin() + static_cast<std::ptrdiff_t>(end));
    at = end;
  }
  return pieces;
}

inline Bytes with_bit_flipped(Bytes stream, std::size_t bit) {
  stream.at(bit / 8) = static_cast<std::uint8_t>(stream.at(bit / 8) ^ (1U << (bit % 8)));
  return stream;
}

inline Bytes without_byte(Bytes stream, std::size_t at) {
  stream.erase(stream.begin() + static_cast<std::ptrdiff_t>(at));
  return stream;
}

inline Bytes with_byte(Bytes stream, std::size_t before, std::uint8_t byte) {
  stream.insert(stream.begin() + static_cast<std::ptrdiff_t>(before), byte);
  return stream;
}

inline Bytes noise(std::size_t size, std::uint64_t seed) {
  Random random{seed};
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) { byte = static_cast<std::uint8_t>(random.below(256)); }
  return bytes;
}

}  // namespace picolo::test
