// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// From reset to main on a Cortex-A53 at EL1 or above: FPU, stack, vectors, .bss, constructors.

#include <cstdint>

extern "C" {
extern std::uint64_t bss_begin[];
extern std::uint64_t bss_end[];
using Constructor = void (*)();
extern Constructor init_array_begin[];
extern Constructor init_array_end[];

[[noreturn]] void start_in_cpp();
// An application defines those that it uses.
[[gnu::weak]] void interrupt_handler();
[[gnu::weak]] void fault_handler();
}

// Vector table: 16 entries of 128 bytes; only the interrupt from EL1 with its own stack is
// expected. It keeps what a C++ function may change: x0 to x18, x29, x30, FPSR, and all vector
// registers (of q8 to q15 a function keeps the lower halves only).
__asm__(R"(
  .section .start, "ax"
  .global start
start:
  mov x0, #(3 << 20)
  msr cpacr_el1, x0
  ldr x0, =vectors
  msr vbar_el1, x0
  isb
  ldr x0, =stack_top
  mov sp, x0
  b start_in_cpp

  .text
  .balign 2048
vectors:
  .rept 5
  .balign 128
  b fault_handler
  .endr
  .balign 128
  b keep_and_handle
  .rept 10
  .balign 128
  b fault_handler
  .endr

keep_and_handle:
  sub sp, sp, #720
  stp x0, x1, [sp, #0]
  stp x2, x3, [sp, #16]
  stp x4, x5, [sp, #32]
  stp x6, x7, [sp, #48]
  stp x8, x9, [sp, #64]
  stp x10, x11, [sp, #80]
  stp x12, x13, [sp, #96]
  stp x14, x15, [sp, #112]
  stp x16, x17, [sp, #128]
  stp x18, x29, [sp, #144]
  str x30, [sp, #160]
  stp q0, q1, [sp, #176]
  stp q2, q3, [sp, #208]
  stp q4, q5, [sp, #240]
  stp q6, q7, [sp, #272]
  stp q8, q9, [sp, #304]
  stp q10, q11, [sp, #336]
  stp q12, q13, [sp, #368]
  stp q14, q15, [sp, #400]
  stp q16, q17, [sp, #432]
  stp q18, q19, [sp, #464]
  stp q20, q21, [sp, #496]
  stp q22, q23, [sp, #528]
  stp q24, q25, [sp, #560]
  stp q26, q27, [sp, #592]
  stp q28, q29, [sp, #624]
  stp q30, q31, [sp, #656]
  mrs x0, fpsr
  str x0, [sp, #688]
  bl interrupt_handler
  ldr x0, [sp, #688]
  msr fpsr, x0
  ldp q0, q1, [sp, #176]
  ldp q2, q3, [sp, #208]
  ldp q4, q5, [sp, #240]
  ldp q6, q7, [sp, #272]
  ldp q8, q9, [sp, #304]
  ldp q10, q11, [sp, #336]
  ldp q12, q13, [sp, #368]
  ldp q14, q15, [sp, #400]
  ldp q16, q17, [sp, #432]
  ldp q18, q19, [sp, #464]
  ldp q20, q21, [sp, #496]
  ldp q22, q23, [sp, #528]
  ldp q24, q25, [sp, #560]
  ldp q26, q27, [sp, #592]
  ldp q28, q29, [sp, #624]
  ldp q30, q31, [sp, #656]
  ldp x2, x3, [sp, #16]
  ldp x4, x5, [sp, #32]
  ldp x6, x7, [sp, #48]
  ldp x8, x9, [sp, #64]
  ldp x10, x11, [sp, #80]
  ldp x12, x13, [sp, #96]
  ldp x14, x15, [sp, #112]
  ldp x16, x17, [sp, #128]
  ldp x18, x29, [sp, #144]
  ldr x30, [sp, #160]
  ldp x0, x1, [sp, #0]
  add sp, sp, #720
  eret
)");

void interrupt_handler() {
  while (true) { __asm__ volatile("" ::: "memory"); }
}

void fault_handler() {
  while (true) { __asm__ volatile("" ::: "memory"); }
}

void start_in_cpp() {
  for (std::uint64_t* to = bss_begin; to != bss_end; ++to) { *to = 0; }
  for (Constructor* make = init_array_begin; make != init_array_end; ++make) { (*make)(); }
  __asm__ volatile("bl main" ::: "memory");  // ISO C++ calls main by no other name
  while (true) {}
}
