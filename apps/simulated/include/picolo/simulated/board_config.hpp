// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How the images configure the simulated vehicle's controller on their processor, and with it the
/// twins of them.
#pragma once

#include "picolo/controller/cortex_m4f.hpp"
#include "picolo/controller/onboard_calibration.hpp"
#include "picolo/simulated/simulated_controller.hpp"

namespace picolo::inline v0 {

/// This code runs where only floats are computed in hardware.
#if defined(__ARM_FP) && (__ARM_FP & 8) == 0
inline constexpr bool kSoftwareDoubles = true;
#else
inline constexpr bool kSoftwareDoubles = false;
#endif

[[nodiscard]] constexpr ControllerConfig board_config(bool software_doubles) {
  const ControllerConfig config = simulated_vehicle_config();
  return software_doubles ? for_cortex_m4f(config) : config;
}

[[nodiscard]] inline OnboardCalibrationConfig board_calibration(const ControllerConfig& config,
                                                                bool software_doubles) {
  const OnboardCalibrationConfig calibration = onboard_calibration(config);
  return software_doubles ? for_cortex_m4f(calibration) : calibration;
}

/// So few points that one slice of their match fits into the background's time.
using BoardCalibration = OnboardCalibration<240>;

}  // namespace picolo::inline v0
