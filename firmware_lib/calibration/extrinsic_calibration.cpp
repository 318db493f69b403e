// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/extrinsic_calibration.hpp"

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

bool finite(const Pose2d& pose) {
  return is_finite(pose.x_m) && is_finite(pose.y_m) && is_finite(pose.theta_rad);
}

/// Variance of one residual; 0 when there are no more rows than unknowns.
double noise_of(const StreamingLeastSquaresCore& system) {
  const auto rows = static_cast<double>(system.rows());
  const auto unknowns = static_cast<double>(system.unknowns());
  return rows > unknowns ? system.residual_squares() / (rows - unknowns) : 0.0;
}

}  // namespace

Status ExtrinsicCalibration::add(const MotionPair& pair) {
  if (!finite(pair.odometry) || !finite(pair.scan)) { return Status::invalid_argument; }
  const Pose2d& o = pair.odometry;
  const Pose2d& s = pair.scan;
  ++samples_;
  const double distance = hypotenuse(o.x_m, o.y_m);
  travelled_m_ += distance;
  turned_rad_ += magnitude(o.theta_rad);
  if (magnitude(o.theta_rad) <= config_.max_straight_turn_rad &&
      distance >= config_.min_distance_m) {
    // s = R(theta) o
    if (!is_ok(yaw_.add({o.x_m, -o.y_m}, s.x_m)) || !is_ok(yaw_.add({o.y_m, o.x_m}, s.y_m))) {
      return Status::invalid_argument;
    }
    ++straight_;
  }
  // R(yaw) s + (1 - R(o)) l = o
  const SinCos<double> turn = sin_cos(o.theta_rad);
  if (!is_ok(all_.add({s.x_m, -s.y_m, 1.0 - turn.cosine, turn.sine}, o.x_m)) ||
      !is_ok(all_.add({s.y_m, s.x_m, -turn.sine, 1.0 - turn.cosine}, o.y_m))) {
    return Status::invalid_argument;
  }
  return Status::ok;
}

Refusal ExtrinsicCalibration::judge_yaw() const {
  if (samples_ < config_.min_samples) {
    return {RefusalReason::too_little_data, Parameter::lidar_yaw};
  }
  if (travelled_m_ < 10.0 * config_.min_distance_m) {
    return {turned_rad_ < 0.1 ? RefusalReason::standing_still : RefusalReason::no_translation,
            Parameter::lidar_yaw};
  }
  return {};
}

Status ExtrinsicCalibration::solve(ExtrinsicReport& report) const {
  report = ExtrinsicReport{};
  report.samples = samples_;
  report.straight = straight_;
  report.condition = all_.core().observability().condition;
  report.yaw_refusal = judge_yaw();
  report.position_refusal = report.yaw_refusal;
  if (report.yaw_refusal) { return Status::degenerate; }

  std::array<double, 4> q{};
  std::array<double, 16> cq{};
  const bool lever_known =
      is_ok(all_.solve(q)) && is_ok(all_.covariance(cq)) && report.condition < 1e6;
  const double all_noise = noise_of(all_.core());
  std::array<double, 2> r{};
  std::array<double, 4> cr{};
  if (straight_ >= config_.min_samples && is_ok(yaw_.solve(r)) && is_ok(yaw_.covariance(cr))) {
    report.yaw_scale = hypotenuse(r[0], r[1]);
    report.yaw_rad = {-arc_tangent2(r[1], r[0]),
                      square_root(noise_of(yaw_.core()) * cr[0]) / report.yaw_scale};
  } else if (lever_known) {
    report.yaw_from_turns = true;
    report.yaw_scale = hypotenuse(q[0], q[1]);
    report.yaw_rad = {arc_tangent2(q[1], q[0]), square_root(all_noise * cq[0]) / report.yaw_scale};
  } else {
    report.yaw_refusal = {RefusalReason::too_little_data, Parameter::lidar_yaw};
  }
  if (!(report.yaw_rad.std <= config_.max_yaw_std_rad) || !(report.yaw_scale > 0.0)) {
    report.yaw_refusal = {RefusalReason::no_translation, Parameter::lidar_yaw};
  }
  if (report.yaw_refusal) {
    report.position_refusal = report.yaw_refusal;
    return Status::degenerate;
  }
  if (!lever_known) {
    report.position_refusal = {RefusalReason::straight_only, Parameter::lidar_x};
    return Status::ok;
  }
  // Put the yaw in: the factor's last two rows couple cos and sin to x and y.
  StreamingLeastSquares<4> fixed;
  const SinCos<double> yaw = sin_cos(report.yaw_rad.value);
  const double weight = 1e6 * (1.0 + travelled_m_);
  if (!is_ok(fixed.core().merge(all_.core())) ||
      !is_ok(fixed.add({1.0, 0.0, 0.0, 0.0}, report.yaw_scale * yaw.cosine, weight)) ||
      !is_ok(fixed.add({0.0, 1.0, 0.0, 0.0}, report.yaw_scale * yaw.sine, weight)) ||
      !is_ok(fixed.solve(q))) {
    return Status::degenerate;
  }
  report.x_m = {q[2], square_root(all_noise * cq[10])};
  report.y_m = {q[3], square_root(all_noise * cq[15])};
  if (!(report.x_m.std <= config_.max_position_std_m)) {
    report.position_refusal = {
        turned_rad_ < 0.3 ? RefusalReason::straight_only : RefusalReason::too_little_data,
        Parameter::lidar_x};
  }
  return Status::ok;
}

}  // namespace picolo::inline v0
