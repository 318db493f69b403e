// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "drive_information.hpp"

#include <algorithm>
#include <limits>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/jacobi_svd.hpp"
#include "picolo/solve/normal_least_squares.hpp"

namespace picolo::inline v0 {
namespace {

/// Welford's update: no cancellation however far the mean is from zero.
void update(double count, double value, double& mean, double& squares) {
  const double before = value - mean;
  mean += before / count;
  squares += before * (value - mean);
}

double deviation(double count, double squares) {
  return std::max(1e-12, count > 1.0 ? square_root(squares / (count - 1.0)) : 0.0);
}

}  // namespace

void add_information(DriveMatrix& information, const DriveJacobian& jacobian, const Pose2d& sigma) {
  const double weights[3] = {1.0 / (sigma.x_m * sigma.x_m), 1.0 / (sigma.y_m * sigma.y_m),
                             1.0 / (sigma.theta_rad * sigma.theta_rad)};
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t i = 0; i < 6; ++i) {
      const double weighted = weights[row] * jacobian[6 * row + i];
      for (std::size_t j = 0; j < 6; ++j) {
        information[6 * i + j] += weighted * jacobian[6 * row + j];
      }
    }
  }
}

Status covariance_of(const DriveMatrix& information, DriveMatrix& covariance, double& condition) {
  condition = std::numeric_limits<double>::infinity();
  DriveMatrix scaled{};
  DriveMatrix v{};
  std::array<double, 6> values{};
  for (std::size_t i = 0; i < 6; ++i) {
    if (!(information[7 * i] > 0.0)) { return Status::degenerate; }
  }
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t j = 0; j < 6; ++j) {
      scaled[6 * i + j] =
          information[6 * i + j] / square_root(information[7 * i] * information[7 * j]);
    }
  }
  if (!is_ok(jacobi_svd(scaled, 6, 6, v, values)) || !(values[5] > 0.0)) {
    return Status::degenerate;
  }
  condition = square_root(values[0] / values[5]);
  return invert_symmetric(information, covariance);
}

void ResidualMoments::add(const Pose2d& residual) {
  count_ += 1.0;
  update(count_, residual.x_m, mean_.x_m, squares_.x_m);
  update(count_, residual.y_m, mean_.y_m, squares_.y_m);
  update(count_, residual.theta_rad, mean_.theta_rad, squares_.theta_rad);
}

Pose2d ResidualMoments::standard_deviation() const {
  return {deviation(count_, squares_.x_m), deviation(count_, squares_.y_m),
          deviation(count_, squares_.theta_rad)};
}

}  // namespace picolo::inline v0
