// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Residual evaluation and solve of a pose from lines and planes, four iterations, in double and in
// the float that the target uses. With Ceres installed, its solver on the same residuals runs
// beside (ceres_benchmark.cpp): the ratio of the two is what counts.

#include <benchmark/benchmark.h>

#include "problem.hpp"

namespace picolo::bench {
namespace {

PoseSolverConfig four_iterations(LineForm form) {
  return {.line_form = form, .max_iterations = 4, .converged_m = 1e-30F, .converged_rad = 1e-30F};
}

void picolo_double(benchmark::State& state, LineForm form) {
  const Problem problem = problem_of(static_cast<std::size_t>(state.range(0)));
  PoseSolver<double> solver{four_iterations(form)};
  for (auto _ : state) {
    benchmark::DoNotOptimize(solver.solve({problem.planes, problem.lines, {}}));
  }
}

void picolo_float(benchmark::State& state) {
  const Problem problem = problem_of(static_cast<std::size_t>(state.range(0)));
  PoseSolver<float> solver{four_iterations(LineForm::two_directions)};
  for (auto _ : state) {
    benchmark::DoNotOptimize(solver.solve({problem.planes_f32, problem.lines_f32, {}}));
  }
}

/// Iterations of Levenberg-Marquardt until the step is below 1e-9: what the lacking rank costs.
void lm_to_convergence(benchmark::State& state, LineForm form) {
  const Problem problem = problem_of(static_cast<std::size_t>(state.range(0)));
  PoseSolver<double> solver{{.method = SolveMethod::levenberg_marquardt,
                             .line_form = form,
                             .max_iterations = 500,
                             .converged_m = 1e-9F,
                             .converged_rad = 1e-9F}};
  int iterations = 0;
  for (auto _ : state) { iterations = solver.solve({{}, problem.lines, {}}).iterations; }
  state.counters["iterations"] = iterations;
}

BENCHMARK_CAPTURE(picolo_double, two_directions, LineForm::two_directions)
    ->Arg(200)
    ->Arg(1000)
    ->Arg(5000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(picolo_double, distance, LineForm::distance)
    ->Arg(200)
    ->Arg(1000)
    ->Arg(5000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(picolo_float)->Arg(200)->Arg(1000)->Arg(5000)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(lm_to_convergence, two_directions, LineForm::two_directions)->Arg(1000);
BENCHMARK_CAPTURE(lm_to_convergence, distance, LineForm::distance)->Arg(1000);

}  // namespace
}  // namespace picolo::bench
