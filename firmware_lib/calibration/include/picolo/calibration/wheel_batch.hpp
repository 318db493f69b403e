// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The wheel model from wheel rates and scan motions of the base: J21, J22 from rotation, then the
/// track width from translation; r_L = -J21 b, r_R = J22 b. Two passes (rotation before
/// translation) over re-readable sources.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/calibration/motion_check.hpp"
#include "picolo/calibration/parameter.hpp"
#include "picolo/calibration/samples.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

struct WheelBatchConfig {
  std::uint64_t limit = 0;  ///< scans to use; 0: all
  MotionNeeds needs{};
  /// A drive that turns less than `needs` asks for is accepted when the wheels explain at least
  /// this share of its rotation: then even small turns stand far above the noise.
  double sufficient_explained = 0.9;
  double max_relative_std = 0.02;  ///< of J21, J22 and b; above: refused
  [[nodiscard]] constexpr bool valid() const {
    return needs.valid() && sufficient_explained > 0.0 && sufficient_explained <= 1.0 &&
           max_relative_std > 0.0;
  }
};

struct WheelReport {
  Estimate j21{};
  Estimate j22{};
  Estimate track_m{};
  Estimate radius_left_m{};
  Estimate radius_right_m{};
  std::array<double, 9> covariance{};  ///< of r_L, r_R, b, row-major
  double condition = 0.0;              ///< of the rotation system
  std::uint64_t used = 0;              ///< scan motions
  Refusal refusal{};
};

/// Status as calibrate_joint. Cost: two passes, one sin_cos a row. State: under 1 KiB.
Status calibrate_wheels(SampleSource<WheelRates>& rates, SampleSource<ScanMotion>& scans,
                        const WheelBatchConfig& config, WheelReport& report);

}  // namespace picolo::inline v0
