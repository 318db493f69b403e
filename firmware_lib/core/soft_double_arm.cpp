// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The sum of two doubles in libgcc 12 for ARM (ieee754-df.S) is wrong in the last bit when the
// exponents differ by 33, the signs differ and the result loses a bit: 1.0 - 1.18e-10 comes out too
// small. It keeps one bit below the last and a sticky bit there, where two are needed. A Cortex-M4F
// has no double-precision hardware, so this library brings the whole member of libgcc, under the
// names of the run-time ABI (IHI 0043); the linker takes them from here because libgcc comes last.
// tests/target compares them with hardware.

#if defined(__arm__) && (!defined(__ARM_FP) || (__ARM_FP & 8) == 0)

#include <cstdint>

#include "picolo/core/soft_double.hpp"

// Doubles travel as their words: in the base calling convention of these functions that is the
// same.
namespace soft = picolo::soft_double;

extern "C" {

std::uint64_t __aeabi_dadd(std::uint64_t a, std::uint64_t b);
std::uint64_t __aeabi_dsub(std::uint64_t a, std::uint64_t b);
std::uint64_t __aeabi_drsub(std::uint64_t a, std::uint64_t b);
std::uint64_t __aeabi_f2d(std::uint32_t a);
std::uint64_t __aeabi_i2d(std::int32_t a);
std::uint64_t __aeabi_ui2d(std::uint32_t a);
std::uint64_t __aeabi_l2d(std::int64_t a);
std::uint64_t __aeabi_ul2d(std::uint64_t a);

std::uint64_t __aeabi_dadd(std::uint64_t a, std::uint64_t b) {
  return soft::sum(a, b);
}
std::uint64_t __aeabi_dsub(std::uint64_t a, std::uint64_t b) {
  return soft::sum(a, b ^ soft::kSign);
}
std::uint64_t __aeabi_drsub(std::uint64_t a, std::uint64_t b) {
  return soft::sum(b, a ^ soft::kSign);
}
std::uint64_t __aeabi_f2d(std::uint32_t a) {
  return soft::from_float(a);
}
std::uint64_t __aeabi_i2d(std::int32_t a) {
  return soft::from_i64(a);
}
std::uint64_t __aeabi_ui2d(std::uint32_t a) {
  return soft::from_u64(a);
}
std::uint64_t __aeabi_l2d(std::int64_t a) {
  return soft::from_i64(a);
}
std::uint64_t __aeabi_ul2d(std::uint64_t a) {
  return soft::from_u64(a);
}

}  // extern "C"

// GCC's own names of the same functions: all or none, else the linker would bring libgcc's member
// as well.
__asm__(R"(
  .global __adddf3, __subdf3, __extendsfdf2, __floatsidf, __floatunsidf, __floatdidf, __floatundidf
  .thumb_set __adddf3, __aeabi_dadd
  .thumb_set __subdf3, __aeabi_dsub
  .thumb_set __extendsfdf2, __aeabi_f2d
  .thumb_set __floatsidf, __aeabi_i2d
  .thumb_set __floatunsidf, __aeabi_ui2d
  .thumb_set __floatdidf, __aeabi_l2d
  .thumb_set __floatundidf, __aeabi_ul2d
)");

#endif
