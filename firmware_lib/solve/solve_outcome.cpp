// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/solve/pose_solver.hpp"

namespace picolo::inline v0 {

const char* to_string(SolveOutcome outcome) {
  switch (outcome) {
    case SolveOutcome::converged: return "converged";
    case SolveOutcome::iteration_limit: return "iteration_limit";
    case SolveOutcome::degenerate: return "degenerate";
    case SolveOutcome::too_few_residuals: return "too_few_residuals";
    case SolveOutcome::unsolvable: break;
  }
  return "unsolvable";
}

}  // namespace picolo::inline v0
