// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// `PoseSolver`, instantiated for float and for double in a file each.
#pragma once

#include "line_plane_sums.hpp"
#include "picolo/core/math.hpp"
#include "picolo/solve/pose_solver.hpp"
#include "symmetric6.hpp"

namespace picolo::inline v0 {
namespace pose_solver {

template <typename T>
symmetric6::Matrix<T> full(const NormalEquations6<T>& system) {
  symmetric6::Matrix<T> m{};
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = row; column < 6; ++column) {
      const T entry = system.upper[system.index(row, column)];
      m[row * 6 + column] = entry;
      m[column * 6 + row] = entry;
    }
  }
  return m;
}

template <typename T>
bool all_finite(const NormalEquations6<T>& system) {
  bool finite = is_finite(system.cost);
  for (const T entry : system.upper) { finite = finite && is_finite(entry); }
  for (const T entry : system.b) { finite = finite && is_finite(entry); }
  return finite;
}

template <typename T>
T largest_diagonal(const NormalEquations6<T>& system) {
  T largest{};
  for (std::size_t i = 0; i < 6; ++i) {
    const T entry = system.upper[system.index(i, i)];
    largest = entry > largest ? entry : largest;
  }
  return largest;
}

template <typename T>
T inner(const symmetric6::Vector<T>& a, const symmetric6::Vector<T>& b) {
  T total{};
  for (std::size_t i = 0; i < 6; ++i) { total += a[i] * b[i]; }
  return total;
}

}  // namespace pose_solver

template <typename T>
NormalEquations6<T> PoseSolver<T>::linearise(const Pose3<T>& pose) const {
  NormalEquations6<T> system;
  accumulate(problem_.planes, pose, config_.plane_kernel, system);
  accumulate(problem_.lines, config_.line_form, pose, config_.line_kernel, system);
  return system;
}

template <typename T>
void PoseSolver<T>::begin(const PoseProblem<T>& problem) {
  problem_ = problem;
  report_ = {};
  report_.pose = problem.start;
  report_.residuals = problem.planes.size() + problem.lines.size();
  damping_ = T(0);
  damping_growth_ = T(2);
  done_ = false;
  if (report_.residuals < static_cast<std::size_t>(config_.min_residuals)) {
    finish(SolveOutcome::too_few_residuals);
    return;
  }
  candidate_ = problem.start;
}

/// Rotation counts in metres of a typical arm; a direction far weaker than the strongest one is
/// not determined by the scene and keeps its start value.
template <typename T>
void PoseSolver<T>::find_degenerate_directions(const NormalEquations6<T>& system) {
  T rotation{};
  T translation{};
  for (std::size_t i = 0; i < 3; ++i) {
    rotation += system.upper[system.index(i, i)];
    translation += system.upper[system.index(i + 3, i + 3)];
  }
  arm_m_ = rotation > T(0) && translation > T(0) ? square_root(rotation / translation) : T(1);
  symmetric6::Matrix<T> m = pose_solver::full(system);
  for (std::size_t row = 0; row < 6; ++row) {
    for (std::size_t column = 0; column < 6; ++column) {
      m[row * 6 + column] /= (row < 3 ? arm_m_ : T(1)) * (column < 3 ? arm_m_ : T(1));
    }
  }
  const auto eigen = symmetric6::eigen(m);
  report_.eigenvalues = eigen.values;
  directions_ = eigen.vectors;
  const T smallest = eigen.values[5] / static_cast<T>(config_.max_condition);
  report_.degenerate_directions = 0;
  for (const T value : eigen.values) { report_.degenerate_directions += value > smallest ? 0 : 1; }
}

/// The step of the present linearisation; false when there is none.
template <typename T>
bool PoseSolver<T>::candidate_step(Tangent3<T>& step) const {
  symmetric6::Matrix<T> m = pose_solver::full(system_);
  for (std::size_t i = 0; i < 6; ++i) { m[i * 6 + i] += damping_; }
  symmetric6::Vector<T> x{};
  if (report_.degenerate_directions == 0) {
    x = system_.b;
    if (!symmetric6::factorise(m)) { return false; }
    symmetric6::substitute(m, x);
  } else {
    // Along each determined direction v alone: (v' H v) alpha = v' b. With H's own eigenvectors
    // that is the remapped solution.
    for (std::size_t k = static_cast<std::size_t>(report_.degenerate_directions); k < 6; ++k) {
      symmetric6::Vector<T> v;
      for (std::size_t i = 0; i < 6; ++i) {
        v[i] = directions_[k * 6 + i] / (i < 3 ? arm_m_ : T(1));
      }
      T curvature{};
      for (std::size_t i = 0; i < 6; ++i) {
        for (std::size_t j = 0; j < 6; ++j) { curvature += v[i] * m[i * 6 + j] * v[j]; }
      }
      if (!(curvature > T(0))) { continue; }
      const T alpha = pose_solver::inner(v, system_.b) / curvature;
      for (std::size_t i = 0; i < 6; ++i) { x[i] += alpha * v[i]; }
    }
  }
  step = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  return is_finite(norm(step.rotation_rad) + norm(step.translation_m));
}

/// Levenberg-Marquardt's verdict on the candidate by the gain ratio (Nielsen 1999).
template <typename T>
bool PoseSolver<T>::judge_candidate(const NormalEquations6<T>& system) {
  const T gain = system_.cost - system.cost;
  if (!(gain >= T(0)) || !pose_solver::all_finite(system)) {
    damping_ *= damping_growth_;
    damping_growth_ *= T(2);
    return false;
  }
  const T ratio = predicted_gain_ > T(0) ? gain / predicted_gain_ : T(1);
  const T shape = T(2) * ratio - T(1);
  const T factor = T(1) - shape * shape * shape;
  damping_ *= factor > T(1) / T(3) ? factor : T(1) / T(3);
  damping_growth_ = T(2);
  return true;
}

template <typename T>
bool PoseSolver<T>::step() {
  if (done_) { return true; }
  const NormalEquations6<T> fresh = linearise(candidate_);
  const bool first = report_.iterations == 0;
  const bool damped = config_.method == SolveMethod::levenberg_marquardt;
  if (first) {
    if (!pose_solver::all_finite(fresh)) { return finish(SolveOutcome::unsolvable); }
    find_degenerate_directions(fresh);
    if (report_.degenerate_directions == 6) { return finish(SolveOutcome::unsolvable); }
    damping_ = damped
                   ? static_cast<T>(config_.initial_damping) * pose_solver::largest_diagonal(fresh)
                   : T(0);
  }
  const bool accepted = first || !damped || judge_candidate(fresh);
  if (accepted) {
    if (!pose_solver::all_finite(fresh)) { return finish(SolveOutcome::unsolvable); }
    system_ = fresh;
    report_.pose = candidate_;
  }
  const bool small = step_m_ < static_cast<T>(config_.converged_m) &&
                     step_rad_ < static_cast<T>(config_.converged_rad);
  if (!first && small) { return finish(SolveOutcome::converged); }
  if (report_.iterations == config_.max_iterations) {
    return finish(SolveOutcome::iteration_limit);
  }

  Tangent3<T> step;
  if (!candidate_step(step)) { return finish(SolveOutcome::unsolvable); }
  step_m_ = norm(step.translation_m);
  step_rad_ = norm(step.rotation_rad);
  T share = T(1);
  if (step_m_ > static_cast<T>(config_.max_step_m)) {
    share = static_cast<T>(config_.max_step_m) / step_m_;
  }
  if (step_rad_ * share > static_cast<T>(config_.max_step_rad)) {
    share = static_cast<T>(config_.max_step_rad) / step_rad_;
  }
  step = {scaled(step.rotation_rad, share), scaled(step.translation_m, share)};
  const symmetric6::Vector<T> x{step.rotation_rad.x,  step.rotation_rad.y,  step.rotation_rad.z,
                                step.translation_m.x, step.translation_m.y, step.translation_m.z};
  predicted_gain_ = (damping_ * pose_solver::inner(x, x) + pose_solver::inner(x, system_.b)) / T(2);
  candidate_ = perturbed(report_.pose, step);
  ++report_.iterations;
  return false;
}

template <typename T>
void PoseSolver<T>::conclude() {
  report_.cost = system_.cost;
  const symmetric6::Matrix<T> m = pose_solver::full(system_);
  report_.information = m;
  const auto freedom = static_cast<T>(system_.count) + static_cast<T>(problem_.lines.size()) - T(6);
  report_.residual_variance = freedom > T(0) ? T(2) * system_.cost / freedom : T(0);
  symmetric6::Matrix<T> factor = m;
  report_.covariance = {};
  if (!symmetric6::factorise(factor)) { return; }
  for (std::size_t column = 0; column < 6; ++column) {
    symmetric6::Vector<T> unit{};
    unit[column] = T(1);
    symmetric6::substitute(factor, unit);
    for (std::size_t row = 0; row <= column; ++row) {
      report_.covariance[row * 6 + column] = report_.residual_variance * unit[row];
      report_.covariance[column * 6 + row] = report_.covariance[row * 6 + column];
    }
  }
}

template <typename T>
bool PoseSolver<T>::finish(SolveOutcome outcome) {
  done_ = true;
  report_.outcome = outcome;
  if (outcome == SolveOutcome::too_few_residuals || outcome == SolveOutcome::unsolvable) {
    report_.pose = problem_.start;
    return true;
  }
  conclude();
  if (report_.degenerate_directions > 0) { report_.outcome = SolveOutcome::degenerate; }
  return true;
}

template <typename T>
PoseSolveReport<T> PoseSolver<T>::solve(const PoseProblem<T>& problem) {
  begin(problem);
  while (!step()) {}
  return report_;
}

}  // namespace picolo::inline v0
