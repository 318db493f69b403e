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
/// A file of the host, or a pipe, for reading; negative when it cannot be opened. One of each kind
/// at a time.
int open_file(const char* path);
int open_output(const char* path);
/// How many bytes were read; fewer than asked for at the end.
std::size_t read_file(int file, std::span<std::uint8_t> bytes);
/// True when all were written; they are not held back.
bool write_file(int file, std::span<const std::uint8_t> bytes);
/// A free-running counter: 25 MHz on Cortex-M boards, 62.5 MHz on the zcu102, standing still on
/// hosts.
std::uint32_t ticks();
/// Lets the emulator work while next to no time passes on the board.
void pause();
/// Ends the program or the machine.
[[noreturn]] void leave(int status);

}  // namespace picolo::platform
