// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "platform.hpp"

namespace picolo::platform {
namespace {

void write_digits(std::uint64_t value, unsigned base, unsigned least) {
  char text[24];
  std::size_t at = sizeof text - 1;
  text[at] = '\0';
  for (unsigned digits = 0; value != 0 || digits < least; ++digits) {
    text[--at] = "0123456789abcdef"[value % base];
    value /= base;
  }
  write(text + at);
}

}  // namespace

void write_hex(std::uint64_t value) {
  write_digits(value, 16, 16);
}

void write_decimal(std::uint64_t value) {
  write_digits(value, 10, 1);
}

}  // namespace picolo::platform
