// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/solve/normal_least_squares.hpp"

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

using Square = std::array<double, kMaxUnknowns * kMaxUnknowns>;

/// In place: L below the diagonal (unit diagonal left out), D on it. False when a pivot vanishes.
bool factorise(std::span<double> m, std::size_t n) {
  for (std::size_t j = 0; j < n; ++j) {
    const double before = m[j * n + j];
    double pivot = before;
    for (std::size_t k = 0; k < j; ++k) { pivot -= m[j * n + k] * m[j * n + k] * m[k * n + k]; }
    if (!(pivot > 1e-15 * before)) { return false; }
    m[j * n + j] = pivot;
    for (std::size_t i = j + 1; i < n; ++i) {
      double value = m[i * n + j];
      for (std::size_t k = 0; k < j; ++k) { value -= m[i * n + k] * m[j * n + k] * m[k * n + k]; }
      m[i * n + j] = value / pivot;
    }
  }
  return true;
}

void substitute(std::span<const double> factor, std::size_t n, std::span<double> x) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) { x[i] -= factor[i * n + k] * x[k]; }
  }
  for (std::size_t i = 0; i < n; ++i) { x[i] /= factor[i * n + i]; }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) { x[i] -= factor[k * n + i] * x[k]; }
  }
}

}  // namespace

Status solve_symmetric(std::span<const double> m, std::span<const double> b, std::span<double> x) {
  const std::size_t n = b.size();
  if (n == 0 || n > kMaxUnknowns || m.size() != n * n || x.size() != n) {
    return Status::invalid_argument;
  }
  Square factor{};
  std::copy(m.begin(), m.end(), factor.begin());
  if (!factorise(factor, n)) { return Status::degenerate; }
  std::array<double, kMaxUnknowns> solution{};
  std::copy(b.begin(), b.end(), solution.begin());
  substitute(factor, n, solution);
  std::copy_n(solution.begin(), n, x.begin());
  return Status::ok;
}

Status invert_symmetric(std::span<const double> m, std::span<double> inverse) {
  std::size_t n = 1;
  while (n * n < m.size()) { ++n; }
  if (n > kMaxUnknowns || m.size() != n * n || inverse.size() != m.size()) {
    return Status::invalid_argument;
  }
  std::array<double, kMaxUnknowns> scale{};
  for (std::size_t i = 0; i < n; ++i) {
    if (!(m[i * n + i] > 0.0)) { return Status::degenerate; }
    scale[i] = 1.0 / square_root(m[i * n + i]);
  }
  Square factor{};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) { factor[i * n + j] = m[i * n + j] * scale[i] * scale[j]; }
  }
  if (!factorise(factor, n)) { return Status::degenerate; }
  for (std::size_t j = 0; j < n; ++j) {
    std::array<double, kMaxUnknowns> column{};
    column[j] = 1.0;
    substitute(factor, n, column);
    for (std::size_t i = 0; i <= j; ++i) {
      inverse[i * n + j] = column[i] * scale[i] * scale[j];
      inverse[j * n + i] = inverse[i * n + j];
    }
  }
  return Status::ok;
}

void NormalLeastSquares::reset() {
  matrix_.fill(0.0);
  right_.fill(0.0);
  rows_ = 0;
}

Status NormalLeastSquares::add(std::span<const double> a, double b, double weight) {
  if (a.size() != unknowns_ || !is_finite(b) || !is_finite(weight) ||
      !std::all_of(a.begin(), a.end(), [](double value) { return is_finite(value); })) {
    return Status::invalid_argument;
  }
  const double square = weight * weight;
  for (std::size_t i = 0; i < unknowns_; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      matrix_[i * unknowns_ + j] += square * a[i] * a[j];
      matrix_[j * unknowns_ + i] = matrix_[i * unknowns_ + j];
    }
    right_[i] += square * a[i] * b;
  }
  ++rows_;
  return Status::ok;
}

Status NormalLeastSquares::solve(std::span<double> x) const {
  if (x.size() != unknowns_) { return Status::invalid_argument; }
  return solve_symmetric(information(), std::span{right_}.first(unknowns_), x);
}

Status NormalLeastSquares::covariance(std::span<double> c) const {
  if (c.size() != unknowns_ * unknowns_) { return Status::invalid_argument; }
  return invert_symmetric(information(), c);
}

}  // namespace picolo::inline v0
