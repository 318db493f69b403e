// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Three ways to least squares, 60 rows of 6 unknowns: cost of folding all rows and solving once.
// The floor is the multiplications of the normal equations' upper triangle alone.

#include <benchmark/benchmark.h>

#include <array>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/solve/svd_least_squares.hpp"
#include "picolo/solve/normal_least_squares.hpp"
#include "picolo/solve/streaming_least_squares.hpp"

namespace {

constexpr std::size_t kRows = 60;
constexpr std::size_t kUnknowns = 6;
using Row = std::array<double, kUnknowns>;

std::vector<Row> rows() {
  picolo::Random random{1};
  std::vector<Row> all(kRows);
  for (Row& row : all) {
    for (double& value : row) { value = random.gaussian(); }
  }
  return all;
}

void floor_kernel(benchmark::State& state) {
  const std::vector<Row> all = rows();
  for (auto _ : state) {
    Row sums{};
    for (const Row& row : all) {
      for (std::size_t i = 0; i < kUnknowns; ++i) {
        for (std::size_t j = i; j < kUnknowns; ++j) { sums[j] += row[i] * row[j]; }
      }
    }
    benchmark::DoNotOptimize(sums);
  }
}
BENCHMARK(floor_kernel);

void normal_equations(benchmark::State& state) {
  const std::vector<Row> all = rows();
  for (auto _ : state) {
    picolo::NormalLeastSquares solver{kUnknowns};
    for (const Row& row : all) { benchmark::DoNotOptimize(solver.add(row, 1.0)); }
    Row x{};
    benchmark::DoNotOptimize(solver.solve(x));
  }
}
BENCHMARK(normal_equations);

void givens(benchmark::State& state) {
  const std::vector<Row> all = rows();
  for (auto _ : state) {
    picolo::StreamingLeastSquares<kUnknowns> solver;
    for (const Row& row : all) { benchmark::DoNotOptimize(solver.add(row, 1.0)); }
    Row x{};
    benchmark::DoNotOptimize(solver.solve(x));
  }
}
BENCHMARK(givens);

void jacobi_svd(benchmark::State& state) {
  const std::vector<Row> all = rows();
  for (auto _ : state) {
    std::array<double, kRows * kUnknowns> a{};
    std::array<double, kRows> b{};
    for (std::size_t k = 0; k < kRows; ++k) {
      for (std::size_t i = 0; i < kUnknowns; ++i) { a[i * kRows + k] = all[k][i]; }
      b[k] = 1.0;
    }
    Row x{};
    std::array<double, kUnknowns * kUnknowns> v{};
    benchmark::DoNotOptimize(picolo::svd_least_squares(a, kRows, b, x, v));
  }
}
BENCHMARK(jacobi_svd);

}  // namespace
