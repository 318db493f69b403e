// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/solve/svd_least_squares.hpp"

#include <algorithm>
#include <array>

#include "picolo/core/number_model.hpp"
#include "picolo/geometry/jacobi_svd.hpp"
#include "picolo/solve/streaming_least_squares.hpp"

namespace picolo::inline v0 {
namespace {

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) { sum += a[i] * b[i]; }
  return sum;
}

}  // namespace

Status svd_least_squares(std::span<double> a, std::size_t rows, std::span<const double> b,
                         std::span<double> x, std::span<double> v, double tolerance) {
  const std::size_t columns = x.size();
  if (b.size() != rows || columns > kMaxUnknowns) { return Status::invalid_argument; }
  std::array<double, kMaxUnknowns> values{};
  const std::span<double> s = std::span{values}.first(columns);
  const Status status = jacobi_svd(a, rows, columns, v, s);
  if (!is_ok(status)) { return status; }
  std::fill(x.begin(), x.end(), 0.0);
  for (std::size_t k = 0; k < columns; ++k) {
    if (!(s[k] > tolerance * s[0])) { break; }
    const double share = dot(a.subspan(k * rows, rows), b) / (s[k] * s[k]);
    for (std::size_t i = 0; i < columns; ++i) { x[i] += share * v[k * columns + i]; }
  }
  return Status::ok;
}

}  // namespace picolo::inline v0
