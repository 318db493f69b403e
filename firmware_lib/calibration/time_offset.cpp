// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/time_offset.hpp"

#include <algorithm>
#include <limits>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/solve/normal_least_squares.hpp"

namespace picolo::inline v0 {
TimeOffsetCore::TimeOffsetCore(const TimeOffsetConfig& config, std::span<LagSums> lags,
                               std::span<WheelAngles> history, std::span<RotationInterval> waiting)
    : config_(config), lags_(lags), history_(history), waiting_(waiting) {}

void TimeOffsetCore::reset() {
  std::fill(lags_.begin(), lags_.end(), LagSums{});
  next_ = 0;
  size_ = 0;
  waiting_first_ = 0;
  waiting_size_ = 0;
  tt_ = 0.0;
  td_ = 0.0;
  dd_ = 0.0;
  intervals_ = 0;
  dropped_ = 0;
  rejected_ = 0;
  gate_fit_ = {};
  gate_lag_ = 0;
  gate_explained_ = 0.0;
  gate_median_ = 0.0;
  open_ = false;
}

double TimeOffsetCore::lag_s(std::size_t index) const {
  const std::size_t middle = lags_.size() / 2;
  const auto half = static_cast<double>(middle);
  return config_.max_offset_s * (static_cast<double>(index) - half) / half;
}

const WheelAngles& TimeOffsetCore::by_age(std::size_t index) const {
  return history_[(next_ + history_.size() - size_ + index) % history_.size()];
}

/// Linear between the samples around the stamp. Precondition: inside of the history.
WheelAngles TimeOffsetCore::at(double stamp_s) const {
  std::size_t low = 0;
  std::size_t high = size_ - 1;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (by_age(middle).stamp_s <= stamp_s ? low : high) = middle;
  }
  const WheelAngles& a = by_age(low);
  const WheelAngles& b = by_age(high);
  const double share = (stamp_s - a.stamp_s) / (b.stamp_s - a.stamp_s);
  return {stamp_s, a.left_rad + share * (b.left_rad - a.left_rad),
          a.right_rad + share * (b.right_rad - a.right_rad)};
}

Status TimeOffsetCore::add_wheels(const WheelAngles& angles) {
  const Status status = offer_wheels(angles);
  while (step(lags_.size())) {}
  return status;
}

Status TimeOffsetCore::add_rotation(double begin_s, double end_s, double theta_rad) {
  const Status status = offer_rotation(begin_s, end_s, theta_rad);
  while (step(lags_.size())) {}
  return status;
}

Status TimeOffsetCore::offer_wheels(const WheelAngles& angles) {
  if (!is_finite(angles.stamp_s) || !is_finite(angles.left_rad) || !is_finite(angles.right_rad)) {
    return Status::invalid_argument;
  }
  if (size_ > 0 && !(angles.stamp_s > by_age(size_ - 1).stamp_s)) { return Status::out_of_range; }
  // What is half served must be finished before its past is overwritten.
  const bool overwrites = size_ == history_.size();
  if (open_ && overwrites &&
      waiting_[waiting_first_].begin_s - config_.max_offset_s < by_age(1).stamp_s) {
    return Status::full;
  }
  history_[next_] = angles;
  next_ = (next_ + 1) % history_.size();
  size_ = std::min(size_ + 1, history_.size());
  return Status::ok;
}

Status TimeOffsetCore::offer_rotation(double begin_s, double end_s, double theta_rad) {
  if (!is_finite(begin_s) || !is_finite(end_s) || !is_finite(theta_rad) || !(end_s > begin_s)) {
    return Status::invalid_argument;
  }
  if (waiting_size_ == waiting_.size()) {
    ++dropped_;
    return Status::full;
  }
  waiting_[(waiting_first_ + waiting_size_) % waiting_.size()] = {begin_s, end_s, theta_rad};
  ++waiting_size_;
  return Status::ok;
}

Status TimeOffsetCore::wheels_at(double stamp_s, WheelAngles& angles) const {
  if (size_ < 2 || stamp_s > by_age(size_ - 1).stamp_s) { return Status::not_ready; }
  if (stamp_s < by_age(0).stamp_s) { return Status::out_of_range; }
  angles = at(stamp_s);
  return Status::ok;
}

bool TimeOffsetCore::step(std::size_t max_lags) {
  if (!open_) { return open_next(); }
  // To fit a lag takes as long as to add to it.
  const std::size_t most = looking_ ? (max_lags + 1) / 2 : max_lags;
  const std::size_t end = std::min(lags_.size(), next_lag_ + most);
  for (; next_lag_ < end; ++next_lag_) { add_to_lag(next_lag_); }
  if (next_lag_ == lags_.size()) { close(); }
  return true;
}

/// Takes the oldest interval in hand, or drops it; false when it must wait on.
bool TimeOffsetCore::open_next() {
  if (waiting_size_ == 0 || size_ < 2) { return false; }
  const RotationInterval& oldest = waiting_[waiting_first_];
  if (oldest.end_s + config_.max_offset_s > by_age(size_ - 1).stamp_s) { return false; }
  const bool forgotten = oldest.begin_s - config_.max_offset_s < by_age(0).stamp_s;
  const bool outlier = !forgotten && is_outlier(oldest);
  if (forgotten || outlier) {
    ++(forgotten ? dropped_ : rejected_);
    waiting_first_ = (waiting_first_ + 1) % waiting_.size();
    --waiting_size_;
    return true;
  }
  const double duration = oldest.end_s - oldest.begin_s;
  tt_ += oldest.theta_rad * oldest.theta_rad;
  td_ += oldest.theta_rad * duration;
  dd_ += duration * duration;
  ++intervals_;
  next_lag_ = 0;
  looking_ = intervals_ >= config_.min_intervals && intervals_ % 8 == 0;
  open_ = true;
  return true;
}

void TimeOffsetCore::add_to_lag(std::size_t index) {
  const RotationInterval& interval = waiting_[waiting_first_];
  const double duration = interval.end_s - interval.begin_s;
  const WheelAngles begin = at(interval.begin_s - lag_s(index));
  const WheelAngles end = at(interval.end_s - lag_s(index));
  const double left = end.left_rad - begin.left_rad;
  const double right = end.right_rad - begin.right_rad;
  LagSums& sums = lags_[index];
  sums.ll += left * left;
  sums.lr += left * right;
  sums.rr += right * right;
  sums.lt += left * interval.theta_rad;
  sums.rt += right * interval.theta_rad;
  sums.ld += left * duration;
  sums.rd += right * duration;
  if (!looking_) { return; }
  const Fit candidate = fit(index);
  if (index == 0 || candidate.squares < looked_fit_.squares) {
    looked_fit_ = candidate;
    looked_lag_ = index;
  }
}

void TimeOffsetCore::close() {
  open_ = false;
  waiting_first_ = (waiting_first_ + 1) % waiting_.size();
  --waiting_size_;
  if (!looking_) { return; }
  gate_lag_ = looked_lag_;
  gate_fit_ = looked_fit_;
  const double around_drift = tt_ - td_ * td_ / dd_;
  gate_explained_ = around_drift > 0.0 ? 1.0 - gate_fit_.squares / around_drift : 0.0;
  if (gate_median_ == 0.0) {
    gate_median_ =
        square_root(std::max(1e-12, gate_fit_.squares / static_cast<double>(intervals_)));
  }
}

/// True when no lag near the best one explains the interval: a slipping wheel or a wrong match, not
/// a clock. Judged only once the wheels explain most of the rotation.
bool TimeOffsetCore::is_outlier(const RotationInterval& interval) {
  if (gate_explained_ < 0.5) { return false; }
  const double step = lag_s(1) - lag_s(0);
  const auto reach = static_cast<std::size_t>(floor_to_i32(0.1 / step, 1, 1 << 20));
  const std::size_t first = gate_lag_ > reach ? gate_lag_ - reach : 0;
  const std::size_t last = std::min(gate_lag_ + reach, lags_.size() - 1);
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = first; k <= last; ++k) {
    const WheelAngles begin = at(interval.begin_s - lag_s(k));
    const WheelAngles end = at(interval.end_s - lag_s(k));
    const double expected = gate_fit_.j21 * (end.left_rad - begin.left_rad) +
                            gate_fit_.j22 * (end.right_rad - begin.right_rad) +
                            gate_fit_.drift * (interval.end_s - interval.begin_s);
    const double error = magnitude(interval.theta_rad - expected);
    nearest = std::min(nearest, error);
    if (k == gate_lag_) { gate_median_ *= error > gate_median_ ? 1.04 : 1.0 / 1.04; }
  }
  return nearest > 6.0 * gate_median_;
}

std::size_t TimeOffsetCore::best_lag(Fit& least) const {
  std::size_t best = 0;
  least = fit(0);
  for (std::size_t k = 1; k < lags_.size(); ++k) {
    const Fit candidate = fit(k);
    if (candidate.squares < least.squares) {
      best = k;
      least = candidate;
    }
  }
  return best;
}

TimeOffsetCore::Fit TimeOffsetCore::fit(std::size_t lag) const {
  const LagSums& s = lags_[lag];
  // A ridge of a millionth keeps wheels that never differ (a straight drive) solvable; it does not
  // move a proper fit.
  const double ridge = 1e-6 * (s.ll + s.rr) + 1e-12;
  const std::array<double, 9> m{s.ll + ridge, s.lr, s.ld, s.lr,       s.rr + ridge,
                                s.rd,         s.ld, s.rd, dd_ + 1e-12};
  const std::array<double, 3> right{s.lt, s.rt, td_};
  std::array<double, 3> x{};
  if (!is_ok(solve_symmetric(m, right, x))) { return {tt_, 0.0, 0.0, 0.0}; }
  return {tt_ - (x[0] * s.lt + x[1] * s.rt + x[2] * td_), x[0], x[1], x[2]};
}

Status TimeOffsetCore::solve(TimeOffsetReport& report) const {
  Fit least;
  const std::size_t best = best_lag(least);
  return solve_at(best, least, report);
}

void TimeOffsetCore::step_walk(Walk& walk) const {
  if (!walk.begun) {
    walk.begun = true;
    walk.best = gate_lag_;
    walk.least = fit(walk.best);
    return;
  }
  const bool at_end = walk.upwards ? walk.best + 1 >= lags_.size() : walk.best == 0;
  const std::size_t next = walk.upwards ? walk.best + 1 : walk.best - 1;
  const Fit candidate = at_end ? walk.least : fit(next);
  if (candidate.squares < walk.least.squares) {
    walk.best = next;
    walk.least = candidate;
    return;
  }
  walk.over = !walk.upwards;
  walk.upwards = false;
}

Status TimeOffsetCore::solve_nearby(TimeOffsetReport& report) const {
  Walk walk;
  while (!walk.over) { step_walk(walk); }
  return solve_at(walk.best, walk.least, report);
}

void TimeOffsetCore::begin_solution() {
  walk_ = {};
}

bool TimeOffsetCore::solve_slice(std::size_t max_fits, TimeOffsetReport& report) {
  if (!walk_.over) {
    for (std::size_t k = 0; k < max_fits && !walk_.over; ++k) { step_walk(walk_); }
    return false;
  }
  static_cast<void>(solve_at(walk_.best, walk_.least, report));
  return true;
}

Status TimeOffsetCore::solve_at(std::size_t best, const Fit& least,
                                TimeOffsetReport& report) const {
  report = TimeOffsetReport{};
  report.intervals = intervals_;
  report.rejected = rejected_;
  const auto refuse = [&](RefusalReason reason) {
    report.refusal = {reason, config_.parameter};
    return Status::degenerate;
  };
  if (intervals_ < config_.min_intervals) { return refuse(RefusalReason::too_little_data); }
  const double n = static_cast<double>(intervals_);
  const double around_drift = tt_ - td_ * td_ / dd_;  // what a constant rate leaves to be explained
  report.explained = around_drift > 0.0 ? 1.0 - least.squares / around_drift : 0.0;
  report.noise_rad = square_root(std::max(0.0, least.squares) / std::max(1.0, n - 4.0));
  report.j21 = least.j21;
  report.j22 = least.j22;
  report.drift_radps = least.drift;
  const std::size_t last = lags_.size() - 1;
  if (best < 2 || best + 2 > last) { return refuse(RefusalReason::constant_velocity); }
  // Least squares parabola through five lags: y = a k^2 + b k + c.
  double even = 0.0;
  double odd = 0.0;
  for (int k = -2; k <= 2; ++k) {
    const double y = fit(best + static_cast<std::size_t>(k + 2) - 2).squares;
    even += (k * k - 2) * y;
    odd += k * y;
  }
  const double curvature = even / 14.0 * 2.0;  // second derivative by the lag's index
  const double slope = odd / 10.0;
  const double step = lag_s(1) - lag_s(0);
  if (!(curvature > 0.0)) { return refuse(RefusalReason::constant_velocity); }
  const double shift = -slope / curvature;
  report.offset_s.value = lag_s(best) + step * std::min(1.0, std::max(-1.0, shift));
  // Residual squares grow by noise^2 at one standard deviation: variance = 2 noise^2 / (d2 squares
  // / d offset^2).
  report.offset_s.std = report.noise_rad * step * square_root(2.0 / curvature);
  if (!(report.offset_s.std <= config_.max_std_s)) {
    return refuse(RefusalReason::constant_velocity);
  }
  if (!(report.explained >= config_.min_explained)) { return refuse(RefusalReason::inconsistent); }
  return magnitude(report.offset_s.value) <= config_.max_offset_s
             ? Status::ok
             : refuse(RefusalReason::constant_velocity);
}

}  // namespace picolo::inline v0
