// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Refuses, at compile time, the compiler settings under which results would depend on the
/// platform. Included by every translation unit of the library that computes with floating-point
/// numbers.
#pragma once

#include <cfloat>
#include <limits>

#ifdef __FAST_MATH__
#error "picolo: -ffast-math breaks the promise of equal bits everywhere; remove the flag"
#endif

#if defined(__FMA__) && defined(__GNUC__) && !defined(__clang__)
#error "picolo: gcc fuses multiply and add in vectors even with -ffp-contract=off; add -mno-fma"
#endif

static_assert(FLT_EVAL_METHOD == 0,
              "picolo needs float arithmetic in float precision (SSE2, VFP, NEON)");
static_assert(std::numeric_limits<float>::is_iec559 && sizeof(float) == 4,
              "picolo needs IEEE 754 binary32");
static_assert(std::numeric_limits<double>::is_iec559 && sizeof(double) == 8,
              "picolo needs IEEE 754 binary64");
