// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/linear_batch.hpp"

#include "picolo/calibration/order_statistic.hpp"
#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {
namespace {

struct Errors {
  double translation_m;
  double rotation_rad;
};

Errors errors_of(const Matrix3d& correction, const MotionPair& pair) {
  const Pose2d o = corrected_by(correction, pair.odometry);
  const double rotation = wrap_angle(o.theta_rad - pair.scan.theta_rad);
  return {hypotenuse(o.x_m - pair.scan.x_m, o.y_m - pair.scan.y_m), magnitude(rotation)};
}

Errors limits_of(SampleSource<MotionPair>& source, const Matrix3d& correction,
                 std::uint64_t index) {
  OrderStatistic translation;
  OrderStatistic rotation;
  translation.select(index);
  rotation.select(index);
  MotionPair pair;
  while (translation.searching() || rotation.searching()) {
    source.rewind();
    while (source.next(pair)) {
      const Errors errors = errors_of(correction, pair);
      translation.offer(errors.translation_m);
      rotation.offer(errors.rotation_rad);
    }
    translation.end_pass();
    rotation.end_pass();
  }
  return {translation.value(), rotation.value()};
}

}  // namespace

Pose2d corrected_by(const Matrix3d& correction, const Pose2d& odometry) {
  const auto row = [&](std::size_t k) {
    return (correction(k, 0) * odometry.x_m + correction(k, 1) * odometry.y_m) +
           correction(k, 2) * odometry.theta_rad;
  };
  return {row(0), row(1), row(2)};
}

Status calibrate_linear(SampleSource<MotionPair>& source, const LinearBatchConfig& config,
                        LinearReport& report) {
  report = LinearReport{};
  if (!config.valid()) { return Status::invalid_argument; }
  std::uint64_t total = 0;
  for (int round = 0; round <= config.outlier_rounds; ++round) {
    Errors limits{};
    const Matrix3d before = report.correction;
    if (round > 0) {
      const double index = config.quantile * static_cast<double>(total);
      limits = limits_of(source, before,
                         static_cast<std::uint64_t>(round_to_i64(index, 0, INT64_C(1) << 62)));
    }
    LinearCalibration calibration;
    MotionPair pair;
    source.rewind();
    while (source.next(pair)) {
      const Errors errors = errors_of(before, pair);
      const bool kept = round == 0 || (!(errors.translation_m > limits.translation_m) &&
                                       !(errors.rotation_rad > limits.rotation_rad));
      if (kept) { static_cast<void>(calibration.add(pair)); }  // what is not finite is not counted
    }
    if (round == 0) { total = calibration.samples(); }
    const Status status = calibration.solve(report);
    if (!is_ok(status)) { return status; }
  }
  return Status::ok;
}

}  // namespace picolo::inline v0
