// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Arm's "Semihosting for AArch32 and AArch64", version 3: a trap instruction with the operation and
// the address of its arguments in the first two registers.

#include <cstring>

#include "platform.hpp"

namespace picolo::platform {
namespace {

using Word = std::uintptr_t;

constexpr Word kOpen = 0x01;
constexpr Word kWrite0 = 0x04;
constexpr Word kWrite = 0x05;
constexpr Word kRead = 0x06;
constexpr Word kGetCommandLine = 0x15;
constexpr Word kExitExtended = 0x20;
constexpr Word kApplicationExit = 0x20026;

Word call(Word operation, const void* arguments) {
#if defined(__aarch64__)
  register Word result __asm__("x0") = operation;
  register const void* block __asm__("x1") = arguments;
  __asm__ volatile("hlt 0xf000" : "+r"(result) : "r"(block) : "memory");
#else
  register Word result __asm__("r0") = operation;
  register const void* block __asm__("r1") = arguments;
  __asm__ volatile("bkpt 0xab" : "+r"(result) : "r"(block) : "memory");
#endif
  return result;
}

}  // namespace

void argument(std::size_t index, std::span<char> word) {
  char line[256] = {};
  const Word block[2] = {reinterpret_cast<Word>(line), sizeof line};
  word[0] = '\0';
  if (call(kGetCommandLine, block) != 0) { return; }
  // QEMU's arg= list: words parted by spaces, the first is the program's name as with main.
  const char* at = line;
  for (std::size_t i = 0; i <= index; ++i) {
    at = std::strchr(at, ' ');
    if (at == nullptr) { return; }
    ++at;
  }
  std::size_t length = 0;
  while (at[length] != '\0' && at[length] != ' ' && length + 1 < word.size()) {
    word[length] = at[length];
    ++length;
  }
  word[length] = '\0';
}

void write(const char* text) {
  (void)call(kWrite0, text);
}

int open_file(const char* path) {
  constexpr Word kReadBinary = 1;
  const Word block[3] = {reinterpret_cast<Word>(path), kReadBinary, std::strlen(path)};
  return static_cast<int>(call(kOpen, block));
}

int open_output(const char* path) {
  constexpr Word kWriteBinary = 5;
  const Word block[3] = {reinterpret_cast<Word>(path), kWriteBinary, std::strlen(path)};
  return static_cast<int>(call(kOpen, block));
}

std::size_t read_file(int file, std::span<std::uint8_t> bytes) {
  std::size_t size = 0;
  while (size < bytes.size()) {  // a pipe gives what it has
    const std::size_t wanted = bytes.size() - size;
    const Word block[3] = {static_cast<Word>(file), reinterpret_cast<Word>(bytes.data() + size),
                           wanted};
    const Word left = call(kRead, block);
    if (left >= wanted) { break; }
    size += wanted - left;
  }
  return size;
}

bool write_file(int file, std::span<const std::uint8_t> bytes) {
  const Word block[3] = {static_cast<Word>(file), reinterpret_cast<Word>(bytes.data()),
                         bytes.size()};
  return call(kWrite, block) == 0;
}

std::uint32_t ticks() {
#if defined(__aarch64__)
  std::uint64_t count = 0;
  __asm__ volatile("isb\n mrs %0, cntvct_el0" : "=r"(count));
  return static_cast<std::uint32_t>(count);
#else
  // CMSDK timer 0 counts down; it is started by its first reading.
  volatile std::uint32_t* const timer = reinterpret_cast<std::uint32_t*>(PICOLO_TIMER_BASE);
  if (timer[0] == 0) {
    timer[2] = 0xFFFFFFFFU;
    timer[1] = 0xFFFFFFFFU;
    timer[0] = 1;
  }
  return 0xFFFFFFFFU - timer[1];
#endif
}

void pause() {
#if defined(__arm__)
  // Code that changes: the emulator translates it anew each time, which takes it as long as ten
  // thousand other instructions, and it holds none of the locks that its devices wait for.
  alignas(4) static constinit volatile std::uint16_t code[2] = {0, 0x4770};  // ..., bx lr
  code[0] = code[0] == 0xBF00 ? 0x46C0 : 0xBF00;                             // nop, or mov r8, r8
  __asm__ volatile("dsb\n isb\n blx %0" ::"r"(reinterpret_cast<Word>(code) | 1U) : "lr", "memory");
#endif
}

void leave(int status) {
  const Word block[2] = {kApplicationExit, static_cast<Word>(status)};
  while (true) { (void)call(kExitExtended, block); }
}

}  // namespace picolo::platform
