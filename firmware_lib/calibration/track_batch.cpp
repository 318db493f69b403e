// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/track_batch.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "arc.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/solve/normal_least_squares.hpp"

namespace picolo::inline v0 {
namespace {

enum : std::size_t { kLeft, kRight, kTrack, kX, kY, kTheta, kMarkerX, kMarkerY, kUnknowns };
using Unknowns = std::array<double, kUnknowns>;
using Matrix = std::array<double, kUnknowns * kUnknowns>;

struct Sums {
  Matrix h{};
  Unknowns g{};  // J^T residual
  double squares = 0.0;
  std::uint64_t positions = 0;
};

/// Pose of base, and its derivatives by the first six unknowns.
struct Walker {
  explicit Walker(const Unknowns& p) : x(p[kX]), y(p[kY]), theta(p[kTheta]) {
    dx[kX] = 1.0;
    dy[kY] = 1.0;
    dtheta[kTheta] = 1.0;
  }

  void roll(const Unknowns& p, double left, double right) {
    const double length = 0.5 * (p[kLeft] * left + p[kRight] * right);
    const double turn = (p[kRight] * right - p[kLeft] * left) / p[kTrack];
    const Arc arc = arc_of(turn);
    const SinCos<double> sc = sin_cos(theta);
    const double u = length * arc.along;
    const double v = length * arc.across;
    const double d_length[3] = {0.5 * left, 0.5 * right, 0.0};
    const double d_turn[3] = {-left / p[kTrack], right / p[kTrack], -turn / p[kTrack]};
    for (std::size_t k = 0; k < 6; ++k) {
      const double l = k < 3 ? d_length[k] : 0.0;
      const double t = k < 3 ? d_turn[k] : 0.0;
      const double du = l * arc.along + length * arc.d_along * t;
      const double dv = l * arc.across + length * arc.d_across * t;
      dx[k] += sc.cosine * du - sc.sine * dv - (sc.sine * u + sc.cosine * v) * dtheta[k];
      dy[k] += sc.sine * du + sc.cosine * dv + (sc.cosine * u - sc.sine * v) * dtheta[k];
      dtheta[k] += t;
    }
    x += sc.cosine * u - sc.sine * v;
    y += sc.sine * u + sc.cosine * v;
    theta += turn;
  }

  double x, y, theta;
  std::array<double, 6> dx{};
  std::array<double, 6> dy{};
  std::array<double, 6> dtheta{};
};

void add_row(Sums& sums, const Unknowns& row, double residual) {
  for (std::size_t i = 0; i < kUnknowns; ++i) {
    sums.g[i] += row[i] * residual;
    for (std::size_t j = 0; j < kUnknowns; ++j) { sums.h[kUnknowns * i + j] += row[i] * row[j]; }
  }
  sums.squares += residual * residual;
}

void add_position(Sums& sums, const Walker& at, const Unknowns& p, const TrackPosition& seen) {
  const SinCos<double> sc = sin_cos(at.theta);
  const double mx = sc.cosine * p[kMarkerX] - sc.sine * p[kMarkerY];
  const double my = sc.sine * p[kMarkerX] + sc.cosine * p[kMarkerY];
  Unknowns x_row{};
  Unknowns y_row{};
  for (std::size_t k = 0; k < 6; ++k) {
    x_row[k] = at.dx[k] - my * at.dtheta[k];
    y_row[k] = at.dy[k] + mx * at.dtheta[k];
  }
  x_row[kMarkerX] = sc.cosine;
  x_row[kMarkerY] = -sc.sine;
  y_row[kMarkerX] = sc.sine;
  y_row[kMarkerY] = sc.cosine;
  add_row(sums, x_row, seen.x_m - (at.x + mx));
  add_row(sums, y_row, seen.y_m - (at.y + my));
  ++sums.positions;
}

/// One pass. Positions before the first wheel sample or after the last are left out.
Sums pass(SampleSource<WheelAngles>& wheels, SampleSource<TrackPosition>& positions,
          const Unknowns& p) {
  Sums sums;
  wheels.rewind();
  positions.rewind();
  WheelAngles from;
  WheelAngles to;
  if (!wheels.next(from) || !wheels.next(to)) { return sums; }
  Walker walker{p};
  TrackPosition seen;
  while (positions.next(seen)) {
    if (seen.stamp_s < from.stamp_s) { continue; }
    while (to.stamp_s < seen.stamp_s) {
      walker.roll(p, to.left_rad - from.left_rad, to.right_rad - from.right_rad);
      from = to;
      if (!wheels.next(to)) { return sums; }
    }
    const double share = to.stamp_s > from.stamp_s
                             ? (seen.stamp_s - from.stamp_s) / (to.stamp_s - from.stamp_s)
                             : 0.0;
    Walker there = walker;
    there.roll(p, share * (to.left_rad - from.left_rad), share * (to.right_rad - from.right_rad));
    add_position(sums, there, p, seen);
  }
  return sums;
}

/// Levenberg-Marquardt over the unknowns from `first` on; those before stay.
double improve(SampleSource<WheelAngles>& wheels, SampleSource<TrackPosition>& positions,
               int iterations, std::size_t first, Unknowns& p, Sums& sums) {
  sums = pass(wheels, positions, p);
  double lambda = 1e-3;
  for (int k = 0; k < iterations && lambda < 1e9; ++k) {
    Matrix damped = sums.h;
    Unknowns g = sums.g;
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      damped[(kUnknowns + 1) * i] += lambda * sums.h[(kUnknowns + 1) * i] + 1e-12;
      for (std::size_t j = 0; i < first && j < kUnknowns; ++j) {
        damped[kUnknowns * i + j] = i == j ? 1.0 : 0.0;
        damped[kUnknowns * j + i] = i == j ? 1.0 : 0.0;
        g[i] = 0.0;
      }
    }
    Unknowns step{};
    Unknowns next = p;
    const bool solved = is_ok(solve_symmetric(damped, g, step));
    for (std::size_t i = 0; i < kUnknowns; ++i) { next[i] += step[i]; }
    if (!solved || !(next[kTrack] > 0.1 * p[kTrack])) {
      lambda *= 10.0;
      continue;
    }
    const Sums tried = pass(wheels, positions, next);
    if (!(tried.squares < sums.squares)) {
      lambda *= 10.0;
      continue;
    }
    const bool settled = sums.squares - tried.squares < 1e-12 * sums.squares;
    p = next;
    sums = tried;
    lambda = std::max(1e-9, 0.2 * lambda);
    if (settled) { break; }
  }
  return sums.squares;
}

double rms(const Sums& sums) {
  return sums.positions > 0 ? square_root(sums.squares / static_cast<double>(sums.positions)) : 0.0;
}

Unknowns unknowns_of(const TrackReport& r) {
  return {r.radius_left_m.value, r.radius_right_m.value, r.track_m.value, r.start.x_m,
          r.start.y_m,           r.start.theta_rad,      r.marker_x_m,    r.marker_y_m};
}

Status judge(const Sums& sums, const Unknowns& p, const TrackBatchConfig& config,
             TrackReport& report) {
  Matrix covariance{};
  const double freedom = 2.0 * static_cast<double>(sums.positions) - static_cast<double>(kUnknowns);
  if (!is_ok(invert_symmetric(sums.h, covariance))) {
    report.refusal = {RefusalReason::numerically_singular, Parameter::track_width};
    return Status::degenerate;
  }
  const double variance = sums.squares / freedom;
  const auto estimate = [&](std::size_t k) {
    return Estimate{p[k], square_root(std::max(0.0, variance * covariance[(kUnknowns + 1) * k]))};
  };
  report.radius_left_m = estimate(kLeft);
  report.radius_right_m = estimate(kRight);
  report.track_m = estimate(kTrack);
  constexpr Parameter kNames[3] = {Parameter::wheel_radius_left, Parameter::wheel_radius_right,
                                   Parameter::track_width};
  const Estimate* const all[3] = {&report.radius_left_m, &report.radius_right_m, &report.track_m};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(all[k]->std <= config.max_relative_std * all[k]->value)) {
      report.refusal = {RefusalReason::too_little_data, kNames[k]};
      return Status::degenerate;
    }
  }
  return Status::ok;
}

}  // namespace

Status calibrate_track(SampleSource<WheelAngles>& wheels, SampleSource<TrackPosition>& positions,
                       const TrackBatchConfig& config, TrackReport& report) {
  report = TrackReport{};
  if (!config.valid()) { return Status::invalid_argument; }
  TrackPosition first;
  positions.rewind();
  static_cast<void>(positions.next(first));
  Sums sums = pass(wheels, positions, {config.radius_m, config.radius_m, config.track_m});
  report.positions = sums.positions;
  if (sums.positions < config.min_positions) {
    report.refusal = {RefusalReason::too_little_data, Parameter::track_width};
    return Status::degenerate;
  }
  double least = std::numeric_limits<double>::infinity();
  Unknowns best{};
  for (int k = 0; k < config.headings; ++k) {
    const double heading =
        2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(config.headings);
    Unknowns p{
        config.radius_m, config.radius_m, config.track_m, first.x_m, first.y_m, heading, 0.0, 0.0};
    static_cast<void>(improve(wheels, positions, config.max_iterations, kX, p, sums));
    if (k == 0 || rms(sums) < report.rms_before_m) { report.rms_before_m = rms(sums); }
    const double squares = improve(wheels, positions, config.max_iterations, kLeft, p, sums);
    if (squares < least) {
      least = squares;
      best = p;
    }
  }
  sums = pass(wheels, positions, best);
  report.rms_after_m = rms(sums);
  report.start = {best[kX], best[kY], wrap_angle(best[kTheta])};
  report.marker_x_m = best[kMarkerX];
  report.marker_y_m = best[kMarkerY];
  return judge(sums, best, config, report);
}

double track_rms_m(SampleSource<WheelAngles>& wheels, SampleSource<TrackPosition>& positions,
                   const TrackReport& report) {
  return rms(pass(wheels, positions, unknowns_of(report)));
}

}  // namespace picolo::inline v0
