// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The pose in space that best fits points to planes and lines: Gauss-Newton and
/// Levenberg-Marquardt on SO(3) x R^3, resumable, with degenerate directions left alone
/// (Zhang, Kaess, Singh 2016, "On degeneracy of optimization-based state estimation problems").
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "picolo/geometry/se3.hpp"
#include "picolo/solve/line_plane_residuals.hpp"
#include "picolo/solve/robust_kernel.hpp"

namespace picolo::inline v0 {

enum class SolveMethod : std::uint8_t { gauss_newton, levenberg_marquardt };

enum class SolveOutcome : std::uint8_t {
  converged,          ///< the last step was below both limits
  iteration_limit,    ///< still moving after the last allowed iteration
  degenerate,         ///< ended, but some directions were left at the start
  too_few_residuals,  ///< fewer than the minimum; the pose is the start
  unsolvable,         ///< no finite solution; the pose is the start
};
[[nodiscard]] const char* to_string(SolveOutcome outcome);

struct PoseSolverConfig {
  SolveMethod method = SolveMethod::gauss_newton;
  LineForm line_form = LineForm::two_directions;
  RobustKernel plane_kernel{};
  RobustKernel line_kernel{};
  int max_iterations = 10;
  int min_residuals = 10;     ///< correspondences, lines and planes together
  float converged_m = 1e-4F;  ///< stop when |dt| and |theta| are both below
  float converged_rad = 1e-5F;
  float max_step_m = 1e3F;  ///< a longer step is shortened, its direction kept
  float max_step_rad = 1.0F;
  /// A direction is left alone when its eigenvalue is below the largest one over this; rotation is
  /// made comparable to metres by the root mean square arm of the points.
  float max_condition = 1e6F;
  float initial_damping = 1e-4F;  ///< of Levenberg-Marquardt, times the largest diagonal element
  [[nodiscard]] constexpr bool valid() const {
    return plane_kernel.valid() && line_kernel.valid() && max_iterations > 0 && min_residuals > 0 &&
           converged_m > 0.0F && converged_rad > 0.0F && max_step_m > 0.0F && max_step_rad > 0.0F &&
           max_condition > 1.0F && initial_damping > 0.0F;
  }
};

/// Everything the caller needs to judge. Matrices are row-major 6 x 6, (rotation, translation).
template <typename T>
struct PoseSolveReport {
  SolveOutcome outcome = SolveOutcome::too_few_residuals;
  int iterations = 0;
  Pose3<T> pose{};                  ///< fixed_T_moving
  std::array<T, 36> information{};  ///< sum w J'J at the last linearisation
  std::array<T, 36> covariance{};   ///< its inverse times the residual variance; 0 when singular
  T cost{};                         ///< sum rho(r^2) / 2 at the last linearisation
  T residual_variance{};            ///< 2 cost / (residuals - 6)
  std::size_t residuals = 0;        ///< correspondences that took part
  std::array<T, 6> eigenvalues{};   ///< of the scaled information at the start, ascending
  int degenerate_directions = 0;
};

/// What is to be fitted; the spans stay valid until the report.
template <typename T>
struct PoseProblem {
  std::span<const PlaneResidual<T>> planes{};
  std::span<const LineResidual<T>> lines{};
  Pose3<T> start{};
};

/// `begin`, then `step` (one pass over the residuals each) until it returns true, then `report`;
/// `solve` is that loop. For `T` float (per scan, on the target) and double (evaluation, tests).
/// Cost: O(residuals) a step. Context: one at a time. No heap; 1 KiB of stack.
template <typename T>
class PoseSolver {
 public:
  explicit PoseSolver(const PoseSolverConfig& config = {}) : config_(config) {}

  void begin(const PoseProblem<T>& problem);
  /// True when the report is final; calling it again then changes nothing.
  bool step();
  [[nodiscard]] const PoseSolveReport<T>& report() const { return report_; }
  [[nodiscard]] bool done() const { return done_; }
  [[nodiscard]] PoseSolveReport<T> solve(const PoseProblem<T>& problem);
  [[nodiscard]] const PoseSolverConfig& config() const { return config_; }

 private:
  [[nodiscard]] NormalEquations6<T> linearise(const Pose3<T>& pose) const;
  void find_degenerate_directions(const NormalEquations6<T>& system);
  [[nodiscard]] bool candidate_step(Tangent3<T>& step) const;
  bool judge_candidate(const NormalEquations6<T>& system);
  void conclude();
  bool finish(SolveOutcome outcome);

  PoseSolverConfig config_;
  PoseProblem<T> problem_{};
  PoseSolveReport<T> report_{};
  NormalEquations6<T> system_{};    ///< at report_.pose
  std::array<T, 36> directions_{};  ///< rows: eigenvectors in scaled units, ascending
  Pose3<T> candidate_{};
  T predicted_gain_{};
  T arm_m_{1};
  T damping_{};
  T damping_growth_{2};
  T step_m_{};
  T step_rad_{};
  bool done_ = true;
};

extern template class PoseSolver<float>;
extern template class PoseSolver<double>;

}  // namespace picolo::inline v0
