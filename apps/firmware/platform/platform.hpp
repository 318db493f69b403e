// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What test images need beside a port: words in, text out, files in, an exit status. On a board
/// through semihosting (a debugger or QEMU answers), on a host through the C library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace picolo::platform {

/// Copies the word with this index, program name not counted, and ends it with 0. Empty when there
/// is none.
void argument(std::size_t index, std::span<char> word);
/// At most 255 characters.
void write(const char* text);
void write_hex(std::uint64_t value);
void write_decimal(std::uint64_t value);
/// A file of the host for reading; negative when it cannot be opened. One at a time.
int open_file(const char* path);
/// How many bytes were read; fewer than asked for at the end.
std::size_t read_file(int file, std::span<std::uint8_t> bytes);
/// Ends the program or the machine.
[[noreturn]] void leave(int status);

}  // namespace picolo::platform
