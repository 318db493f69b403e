// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/displacement_predictor.hpp"

#include "arc.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

struct Rows {
  std::array<double, 4> x;
  std::array<double, 4> y;
};

/// The left wheel's share in the way of the base, r_L / (r_L + r_R): one half until the gains are
/// believable. The gains' own size must not enter: before the first turn it is unknown, and n would
/// learn a way in the wrong unit.
double left_share(const RotationGain& gain) {
  const double difference = gain.j22 - gain.j21;
  const double share = difference > 0.0 ? -gain.j21 / difference : 0.5;
  return share > 0.35 && share < 0.65 ? share : 0.5;
}

Rows rows_of(const RotationGain& gain, const MotionSample& sample) {
  const double left = sample.duration_s * sample.left_radps;
  const double right = sample.duration_s * sample.right_radps;
  const double turn = gain.j21 * left + gain.j22 * right;
  const double share = left_share(gain);
  const double length = share * left + (1.0 - share) * right;
  const Arc arc = arc_of(turn);
  const SinCos<double> sc = sin_cos(turn);
  const double cx = length * arc.along;
  const double cy = length * arc.across;
  return {{cx, -cy, sc.cosine - 1.0, -sc.sine}, {cy, cx, sc.sine, sc.cosine - 1.0}};
}

double dot(const std::array<double, 4>& a, const std::array<double, 4>& b) {
  return (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3]);
}

}  // namespace

void DisplacementPredictor::reset() {
  system_.reset();
  solution_.fill(0.0);
  covariance_.fill(0.0);
}

void DisplacementPredictor::add(const RotationGain& gain, const MotionSample& sample) {
  const Rows rows = rows_of(gain, sample);
  // Finite by the caller's check; a row that is not is refused and leaves the sums alone.
  static_cast<void>(system_.add(rows.x, sample.lidar_motion.x_m));
  static_cast<void>(system_.add(rows.y, sample.lidar_motion.y_m));
}

void DisplacementPredictor::refresh() {
  NormalLeastSquares with_prior = system_;
  constexpr double kPrior =
      1e-3;  // against sums of squares of turns: far below one sample that shows anything
  for (std::size_t k = 0; k < 4; ++k) {
    std::array<double, 4> row{};
    row[k] = 1.0;
    static_cast<void>(with_prior.add(row, 0.0, kPrior));
  }
  static_cast<void>(with_prior.solve(solution_));
  static_cast<void>(with_prior.covariance(covariance_));
}

DisplacementPredictor::Judgement DisplacementPredictor::judge(const RotationGain& gain,
                                                              const MotionSample& sample) const {
  const Rows rows = rows_of(gain, sample);
  Judgement result{sample.lidar_motion.x_m - dot(rows.x, solution_),
                   sample.lidar_motion.y_m - dot(rows.y, solution_), 0.0};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      result.leverage +=
          0.5 * covariance_[4 * i + j] * (rows.x[i] * rows.x[j] + rows.y[i] * rows.y[j]);
    }
  }
  return result;
}

}  // namespace picolo::inline v0
