// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/joint_streaming.hpp"

#include <algorithm>

#include "arc.hpp"
#include "drive_information.hpp"
#include "joint_system.hpp"
#include "joint_turns.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/solve/normal_least_squares.hpp"
#include "quadratic.hpp"

namespace picolo::inline v0 {
namespace {

/// One step of a running median: grows and shrinks by the same factor, so it rests where half of
/// the values are above.
void follow_median(double& scale, double value) {
  constexpr double kStep = 0.04;
  const double median = scale / kMedianToSigma;
  scale *= value > median ? 1.0 + kStep : 1.0 / (1.0 + kStep);
}

/// What was found missing before stands.
Status refuse(JointReport& report, RefusalReason reason, Parameter parameter) {
  if (!report.refusal) { report.refusal = {reason, parameter}; }
  return Status::degenerate;
}

}  // namespace

Status JointStreaming::offer(const MotionSample& sample) {
  const Pose2d& s = sample.lidar_motion;
  if (!(sample.duration_s > 0.0) || !is_finite(sample.duration_s) ||
      !is_finite(sample.left_radps) || !is_finite(sample.right_radps) || !is_finite(s.x_m) ||
      !is_finite(s.y_m) || !is_finite(s.theta_rad)) {
    return Status::invalid_argument;
  }
  if (held_ == waiting_.size()) { return Status::full; }
  waiting_[(oldest_ + held_) % waiting_.size()] = sample;
  if (samples_ < kWarmUp) { waited_.add(sample); }
  ++held_;
  ++samples_;
  return Status::ok;
}

Status JointStreaming::add(const MotionSample& sample) {
  const Status status = offer(sample);
  while (step()) {}
  return status;
}

void JointStreaming::reset() {
  // Field by field: a fresh object to copy from would need 8 KiB of stack.
  check_ = MotionCheck{};
  waited_ = MotionCheck{};
  moments_.fill({});
  reference_ = {};
  first_gain_ = {};
  information_translation_.fill(0.0);
  information_rotation_.fill(0.0);
  drive_ = {};
  gain_ = {};
  gain_covariance_.fill(0.0);
  predictor_.reset();
  solved_ = false;
  gains_known_ = false;
  scale_rotation_rad_ = 0.0;
  scale_translation_m_ = 0.0;
  squares_rotation_ = 0.0;
  squares_translation_ = 0.0;
  gated_rotation_ = 0;
  gated_translation_ = 0;
  samples_ = 0;
  rejected_ = 0;
  stage_ = Stage::gather;
  part_ = Part::gate;
  round_ = 0;
  next_ = 0;
  refreshes_due_ = 0;
  consumed_ = 0;
  first_median_ = 0.0;
  limit_ = 0.0;
  oldest_ = 0;
  held_ = 0;
}

bool JointStreaming::step() {
  if (refreshes_due_ > 0) {
    refreshes_due_ == 2 ? refresh_gate() : refresh_solution();
    --refreshes_due_;
    return true;
  }
  switch (stage_) {
    case Stage::gather:
      if (held_ < kWarmUp) { return false; }
      stage_ = Stage::noise;
      return true;
    case Stage::noise: noise_slice(); return true;
    case Stage::keep: keep_turns(); return true;
    case Stage::predictor: predictor_slice(); return true;
    case Stage::consume: break;
  }
  if (held_ == 0) { return false; }
  consume_slice();
  return true;
}

void JointStreaming::consume_slice() {
  const MotionSample& sample = waiting_[oldest_];
  switch (part_) {
    case Part::gate:
      ++consumed_;
      if (!passes(sample)) {
        ++rejected_;
        release();
        return;
      }
      check_.add(sample);
      // Those that waited are in it already.
      if (consumed_ > kWarmUp && gains_known_) { predictor_.add(gain_, sample); }
      part_ = Part::moments;
      return;
    case Part::moments:
      add_moments(sample, 0, kMoments / 2);
      part_ = Part::more_moments;
      return;
    case Part::more_moments:
      add_moments(sample, kMoments / 2, kMoments);
      part_ = Part::information;
      return;
    case Part::information:
      if (solved_) { add_to_information(sample); }
      release();
      return;
  }
}

/// The oldest sample is done with.
void JointStreaming::release() {
  oldest_ = (oldest_ + 1) % waiting_.size();
  --held_;
  part_ = Part::gate;
  const bool due = consumed_ == kWarmUp || (consumed_ > kWarmUp && consumed_ % 4 == 0);
  refreshes_due_ = due ? 2 : 0;
}

bool JointStreaming::passes(const MotionSample& sample) {
  const Turns turn = turns_of(sample);
  const auto& c = gain_covariance_;
  const double error =
      wrap_angle(sample.lidar_motion.theta_rad - (gain_.j21 * turn.left + gain_.j22 * turn.right));
  const double leverage = turn.left * turn.left * c[0] + 2.0 * turn.left * turn.right * c[1] +
                          turn.right * turn.right * c[3];
  const double spread = scale_rotation_rad_ * scale_rotation_rad_ * (1.0 + leverage);
  bool good = !(error * error > config_.gate_rotation * spread);
  follow_median(scale_rotation_rad_, magnitude(error) / square_root(1.0 + leverage));
  if (good && consumed_ > kWarmUp) {
    squares_rotation_ += error * error / (1.0 + leverage);
    ++gated_rotation_;
  }
  gains_known_ =
      leverage <
      1.0;  // else the turn is news: neither predict displacements by it nor learn from them
  if (!gains_known_) { return good; }
  const auto judged = predictor_.judge(gain_, sample);
  const double distance = hypotenuse(judged.x_m, judged.y_m) / square_root(1.0 + judged.leverage);
  good = good && !(distance * distance >
                   config_.gate_translation * scale_translation_m_ * scale_translation_m_);
  follow_median(scale_translation_m_, distance / (kMedianToRayleigh * kMedianToSigma));
  if (good && consumed_ > kWarmUp) {
    squares_translation_ += 0.5 * distance * distance;
    ++gated_translation_;
  }
  return good;
}

/// Moments `from` to before `to`, in the order of the triangle's rows.
void JointStreaming::add_moments(const MotionSample& sample, std::size_t from, std::size_t to) {
  const Turns turn = turns_of(sample);
  const Quadratic o =
      linear_form(reference_.j21 * turn.left + reference_.j22 * turn.right, turn.left, turn.right);
  const Quadratic length =
      linear_form(0.5 * (reference_.j22 * turn.right - reference_.j21 * turn.left),
                  -0.5 * turn.left, 0.5 * turn.right);
  const Arc arc = arc_of(o[0]);
  const SinCos<double> sc = sin_cos(o[0]);
  const Quadratic cosine = chain(o, sc.cosine, -sc.sine, -sc.cosine);
  const Quadratic sine = chain(o, sc.sine, sc.cosine, -sc.sine);
  const Quadratic zero{};
  const Quadratic versine = linear_form(1.0, 0.0, 0.0) - cosine;
  const Quadratic cx = (-1.0) * (length * chain(o, arc.along, arc.d_along, arc.dd_along));
  const Quadratic cy = (-1.0) * (length * chain(o, arc.across, arc.d_across, arc.dd_across));
  const Quadratic sx = linear_form(sample.lidar_motion.x_m, 0.0, 0.0);
  const Quadratic sy = linear_form(sample.lidar_motion.y_m, 0.0, 0.0);
  const std::array<Quadratic, 5> x{cx, versine, sine, sx, zero - sy};
  const std::array<Quadratic, 5> y{cy, zero - sine, versine, sy, sx};
  std::size_t k = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      if (k >= from && k < to) { add_to(moments_[k], x[i] * x[j] + y[i] * y[j]); }
      ++k;
    }
  }
}

void JointStreaming::add_to_information(const MotionSample& sample) {
  const DriveJacobian jacobian = lidar_motion_jacobian(drive_, sample);
  constexpr double kNever = 1e150;
  add_information(information_translation_, jacobian, {1.0, 1.0, kNever});
  add_information(information_rotation_, jacobian, {kNever, kNever, 1.0});
}

Pose2d JointStreaming::noise() const {
  constexpr std::uint64_t kEnough = 64;
  const auto mean = [](double squares, std::uint64_t count) {
    return std::max(1e-6, square_root(squares / static_cast<double>(count)));
  };
  const double translation_m = gated_translation_ < kEnough
                                   ? scale_translation_m_
                                   : mean(squares_translation_, gated_translation_);
  const double rotation_rad =
      gated_rotation_ < kEnough ? scale_rotation_rad_ : mean(squares_rotation_, gated_rotation_);
  return {translation_m, translation_m, rotation_rad};
}

Status JointStreaming::current(RotationGain& gain, DriveParameters& drive) const {
  const Status status = check_.rotation_gain(gain);
  if (!is_ok(status)) { return status; }
  const double a = gain.j21 - reference_.j21;
  const double b = gain.j22 - reference_.j22;
  JointMatrix m{};
  std::size_t k = 0;
  for (std::size_t i = 0; i < 5; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      m[5 * i + j] = evaluate(moments_[k], a, b);
      m[5 * j + i] = m[5 * i + j];
      ++k;
    }
  }
  return solve_joint(m, gain, drive);
}

void JointStreaming::follow_gain(const MotionCheck& seen) {
  constexpr double kPlausible =
      0.5;  // rad of heading a rad of wheel: the gains' spread over all vehicles
  const double share = scale_rotation_rad_ / kPlausible;
  seen.gain_with_prior(first_gain_, share * share, gain_, gain_covariance_);
}

void JointStreaming::refresh_gate() {
  follow_gain(check_);
  predictor_.refresh();
}

void JointStreaming::refresh_solution() {
  DriveParameters drive;
  // Until turn and speed have both been seen, gains and lever arm are guesses: gate on rotation
  // only, reference stays.
  const bool varied =
      check_.speed_share() > 1e-3 && check_.speed_share() < 0.999 && check_.arc_spread() > 1e-3;
  RotationGain gain;
  if (!varied || !is_ok(current(gain, drive))) { return; }
  const double a = gain_.j21 - reference_.j21;
  const double b = gain_.j22 - reference_.j22;
  if (hypotenuse(a, b) > 0.002 * hypotenuse(gain_.j21, gain_.j22)) {
    for (Quadratic& moment : moments_) { moment = shifted(moment, a, b); }
    reference_ = gain_;
  }
  drive_ = drive;
  solved_ = true;
}

Status JointStreaming::solve(JointReport& report, bool with_condition) const {
  const Status status = solve_drive(report);
  if (!is_ok(status)) { return status; }
  solve_information(report);
  return solve_deviations(report, with_condition);
}

Status JointStreaming::solve_drive(JointReport& report) const {
  report = JointReport{};
  report.samples = samples_;
  report.used = check_.samples();
  if (stage_ != Stage::consume) {  // nothing has passed the gate: judge what waits
    report.refusal = waited_.judge(config_.needs);
    if (!report.refusal) {
      report.refusal = {RefusalReason::too_little_data, Parameter::track_width};
    }
    return Status::degenerate;
  }
  report.refusal = check_.judge(config_.needs);
  if (!is_ok(current(report.gain, report.drive)) || !solved_) {
    return refuse(report, RefusalReason::numerically_singular, Parameter::track_width);
  }
  return Status::ok;
}

void JointStreaming::solve_information(JointReport& report) const {
  report.noise = noise();
  const double translation2 = report.noise.x_m * report.noise.x_m;
  const double rotation2 = report.noise.theta_rad * report.noise.theta_rad;
  for (std::size_t k = 0; k < 36; ++k) {
    report.covariance[k] =
        information_translation_[k] / translation2 + information_rotation_[k] / rotation2;
  }
}

Status JointStreaming::solve_deviations(JointReport& report, bool with_condition) const {
  const DriveMatrix information = report.covariance;
  report.covariance = {};
  const Status inverted = with_condition
                              ? covariance_of(information, report.covariance, report.condition)
                              : invert_symmetric(information, report.covariance);
  if (!is_ok(inverted)) {
    return refuse(report, RefusalReason::numerically_singular, Parameter::lidar_yaw);
  }
  report.inlier_covariance = report.covariance;
  const DriveParameters& d = report.drive;
  const double limits[6] = {config_.max_relative_std * d.radius_left_m,
                            config_.max_relative_std * d.radius_right_m,
                            config_.max_relative_std * d.track_m,
                            config_.max_position_std_m,
                            config_.max_position_std_m,
                            config_.max_yaw_std_rad};
  constexpr Parameter kOrder[6] = {Parameter::wheel_radius_left, Parameter::wheel_radius_right,
                                   Parameter::track_width,       Parameter::lidar_x,
                                   Parameter::lidar_y,           Parameter::lidar_yaw};
  for (std::size_t k = 0; k < 6; ++k) {
    if (!(report.covariance[7 * k] <= limits[k] * magnitude(limits[k]))) {
      return refuse(report, RefusalReason::too_little_data, kOrder[k]);
    }
  }
  return report.refusal ? Status::degenerate : Status::ok;
}

}  // namespace picolo::inline v0
