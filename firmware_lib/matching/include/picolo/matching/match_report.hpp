// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every matcher is asked and what it answers.
#pragma once

#include <cstdint>

#include "picolo/geometry/pose2.hpp"
#include "picolo/solve/normal_equations.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

enum class MatchOutcome : std::uint8_t {
  converged,        ///< the last step was below both limits
  iteration_limit,  ///< still moving after the last allowed iteration
  degenerate,       ///< ended, but the scan leaves a direction open: condition above its limit
  step_limit,       ///< wanted to move further from the start than allowed; the pose is the start
  too_few_points,   ///< not enough measurements; the pose is the start
  out_of_map,       ///< not enough of them inside of the map; the pose is the start
  unsolvable,       ///< the normal equations have no finite solution; the pose is the start
};

inline constexpr int kMatchOutcomes = 7;
[[nodiscard]] const char* to_string(MatchOutcome outcome);

/// A belief about the pose that is fused with the scan, e.g. from odometry.
struct PosePrior {
  Pose2f pose{};           ///< window_T_base
  Matrix3f information{};  ///< inverse covariance, window axes; zero: no prior
};

struct MatchRequest {
  PointsView points{};  ///< in base, at the reference instant; must stay valid until the report
  Pose2f start{};       ///< window_T_base: where the iteration begins
  PosePrior prior{};
};

/// Everything the caller needs to judge.
struct MatchReport {
  MatchOutcome outcome = MatchOutcome::too_few_points;
  int iterations = 0;
  Pose2f pose{};                ///< window_T_base
  Matrix3f scan_information{};  ///< of the scan alone, window axes (1/m^2, 1/(m rad), 1/rad^2)
  Matrix3f covariance{};        ///< inverse of scan and prior information together
  float length_m = 1.0F;        ///< that scales theta: root mean square distance of the points
  Conditioning conditioning{};  ///< of the scan information: how well each direction is seen
  /// Directions that the scan leaves open: eigenvalues of the scaled information below their limit.
  /// The prior alone decides along them; without one the start does.
  int open_directions = 0;
  float cost = 0.0F;  ///< robust squared residuals over sigma plus the prior's part; comparable
                      ///< between starts of one request
  float mean_residual_m = 0.0F;       ///< mean of (1 - M) * reach over points inside of the window
  float residual_variance_m2 = 0.0F;  ///< mean of weighted squares; of field matchers
  float inlier_share = 0.0F;          ///< of the points: within the inlier distance of an obstacle
  int points = 0;                     ///< points that took part
};

}  // namespace picolo::inline v0
