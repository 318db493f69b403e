// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What both parts of the streaming calibration share.
#pragma once

#include "picolo/calibration/samples.hpp"
#include "picolo/core/arithmetic.hpp"

namespace picolo::inline v0 {

inline constexpr double kMedianToSigma = 1.4826;     // of |normal|
inline constexpr double kMedianToRayleigh = 1.1774;  // sigma to median of a Rayleigh variable

struct Turns {
  double left;
  double right;
};

inline Turns turns_of(const MotionSample& sample) {
  return {sample.duration_s * sample.left_radps, sample.duration_s * sample.right_radps};
}

}  // namespace picolo::inline v0
