// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// From reset to main on a Cortex-M: vector table, FPU, .data, .bss, constructors.

#include <cstddef>
#include <cstdint>

extern "C" {
extern std::uint32_t data_image[];
extern std::uint32_t data_begin[];
extern std::uint32_t data_end[];
extern std::uint32_t bss_begin[];
extern std::uint32_t bss_end[];
extern std::uint32_t stack_top[];
using Constructor = void (*)();
extern Constructor init_array_begin[];
extern Constructor init_array_end[];

[[noreturn]] void reset_handler();
void unexpected_handler();
// An application, or the port's interrupts.cpp, defines those that it uses.
[[gnu::weak, gnu::alias("unexpected_handler")]] void nmi_handler();
[[gnu::weak, gnu::alias("unexpected_handler")]] void fault_handler();
[[gnu::weak, gnu::alias("unexpected_handler")]] void systick_handler();
[[gnu::weak, gnu::alias("unexpected_handler")]] void interrupt_handler();
}

namespace {

volatile std::uint32_t& word_at(std::uintptr_t address) {
  return *reinterpret_cast<volatile std::uint32_t*>(address);
}

constexpr std::uintptr_t kCoprocessorAccess = 0xE000ED88;
constexpr std::uintptr_t kConfiguration = 0xE000ED14;
constexpr std::size_t kInterrupts = 64;

struct VectorTable {
  std::uint32_t* stack;
  Constructor system[15];
  Constructor interrupts[kInterrupts];
};

constexpr VectorTable table() {
  VectorTable vectors{stack_top, {}, {}};
  for (Constructor& vector : vectors.system) { vector = unexpected_handler; }
  for (Constructor& vector : vectors.interrupts) { vector = interrupt_handler; }
  vectors.system[0] = reset_handler;
  vectors.system[1] = nmi_handler;
  vectors.system[2] = fault_handler;
  vectors.system[14] = systick_handler;
  return vectors;
}

[[gnu::section(".vectors"), gnu::used]] constexpr VectorTable kVectors = table();

}  // namespace

// Nobody expects it: stop here, where a debugger or the watchdog finds the board.
void unexpected_handler() {
  while (true) { __asm__ volatile("" ::: "memory"); }
}

void reset_handler() {
  word_at(kCoprocessorAccess) = word_at(kCoprocessorAccess) | (0xFU << 20);
  word_at(kConfiguration) = word_at(kConfiguration) & ~(1U << 3);  // unaligned words are no faults
  __asm__ volatile("dsb\n isb" ::: "memory");
  std::uint32_t* from = data_image;
  for (std::uint32_t* to = data_begin; to != data_end; ++to) { *to = *from++; }
  for (std::uint32_t* to = bss_begin; to != bss_end; ++to) { *to = 0; }
  for (Constructor* make = init_array_begin; make != init_array_end; ++make) { (*make)(); }
  __asm__ volatile("bl main" ::: "memory");  // ISO C++ calls main by no other name
  while (true) { unexpected_handler(); }
}
