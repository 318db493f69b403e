// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/match_report.hpp"

namespace picolo::inline v0 {

const char* to_string(MatchOutcome outcome) {
  switch (outcome) {
    case MatchOutcome::converged: return "converged";
    case MatchOutcome::iteration_limit: return "iteration_limit";
    case MatchOutcome::degenerate: return "degenerate";
    case MatchOutcome::step_limit: return "step_limit";
    case MatchOutcome::too_few_points: return "too_few_points";
    case MatchOutcome::out_of_map: return "out_of_map";
    case MatchOutcome::unsolvable: return "unsolvable";
  }
  return "unknown";
}

}  // namespace picolo::inline v0
