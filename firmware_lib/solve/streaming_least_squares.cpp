// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/solve/streaming_least_squares.hpp"

#include <algorithm>
#include <limits>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/jacobi_svd.hpp"

namespace picolo::inline v0 {
namespace {

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return is_finite(value); });
}

}  // namespace

std::size_t Observability::weakest_unknown() const {
  std::size_t best = 0;
  for (std::size_t i = 1; i < unknowns; ++i) {
    if (magnitude(weakest[i]) > magnitude(weakest[best])) { best = i; }
  }
  return best;
}

StreamingLeastSquaresCore::StreamingLeastSquaresCore(std::span<double> storage,
                                                     std::size_t unknowns)
    : storage_(storage), unknowns_(unknowns) {
  reset();
}

void StreamingLeastSquaresCore::reset() {
  std::fill(storage_.begin(), storage_.end(), 0.0);
  rows_ = 0;
  residual_squares_ = 0.0;
}

void StreamingLeastSquaresCore::fold(std::span<double> row, double value) {
  for (std::size_t k = 0; k < unknowns_; ++k) {
    if (row[k] == 0.0) { continue; }
    double& pivot = storage_[index(k, k)];
    const double length = hypotenuse(pivot, row[k]);
    const double cosine = pivot / length;
    const double sine = row[k] / length;
    pivot = length;
    for (std::size_t j = k + 1; j < unknowns_; ++j) {
      double& r = storage_[index(k, j)];
      const double rotated = cosine * r + sine * row[j];
      row[j] = cosine * row[j] - sine * r;
      r = rotated;
    }
    double& d = storage_[right_hand(k)];
    const double rotated = cosine * d + sine * value;
    value = cosine * value - sine * d;
    d = rotated;
  }
  residual_squares_ += value * value;
}

Status StreamingLeastSquaresCore::add(std::span<const double> a, double b, double weight) {
  if (a.size() != unknowns_ || !all_finite(a) || !is_finite(b) || !is_finite(weight)) {
    return Status::invalid_argument;
  }
  std::array<double, kMaxUnknowns> row{};
  for (std::size_t i = 0; i < unknowns_; ++i) { row[i] = weight * a[i]; }
  fold(row, weight * b);
  ++rows_;
  return Status::ok;
}

Status StreamingLeastSquaresCore::merge(const StreamingLeastSquaresCore& other) {
  if (other.unknowns_ != unknowns_) { return Status::invalid_argument; }
  for (std::size_t k = 0; k < unknowns_; ++k) {
    std::array<double, kMaxUnknowns> row{};
    for (std::size_t j = k; j < unknowns_; ++j) { row[j] = other.factor(k, j); }
    fold(row, other.storage_[right_hand(k)]);
  }
  residual_squares_ += other.residual_squares_;
  rows_ += other.rows_;
  return Status::ok;
}

bool StreamingLeastSquaresCore::determined() const {
  double largest = 0.0;
  for (std::size_t k = 0; k < unknowns_; ++k) {
    largest = std::max(largest, magnitude(factor(k, k)));
  }
  for (std::size_t k = 0; k < unknowns_; ++k) {
    if (!(magnitude(factor(k, k)) > 1e-13 * largest)) { return false; }
  }
  return true;
}

Status StreamingLeastSquaresCore::solve(std::span<double> x) const {
  if (x.size() != unknowns_) { return Status::invalid_argument; }
  if (!determined()) { return Status::degenerate; }
  for (std::size_t k = unknowns_; k-- > 0;) {
    double value = storage_[right_hand(k)];
    for (std::size_t j = k + 1; j < unknowns_; ++j) { value -= factor(k, j) * x[j]; }
    x[k] = value / factor(k, k);
  }
  return Status::ok;
}

Status StreamingLeastSquaresCore::covariance(std::span<double> c) const {
  const std::size_t n = unknowns_;
  if (c.size() != n * n) { return Status::invalid_argument; }
  if (!determined()) { return Status::degenerate; }
  std::array<double, kMaxUnknowns * kMaxUnknowns> inverse{};  // R^-1, upper triangle, row-major
  for (std::size_t column = 0; column < n; ++column) {
    for (std::size_t k = column + 1; k-- > 0;) {
      double value = k == column ? 1.0 : 0.0;
      for (std::size_t j = k + 1; j <= column; ++j) {
        value -= factor(k, j) * inverse[j * n + column];
      }
      inverse[k * n + column] = value / factor(k, k);
    }
  }
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = row; column < n; ++column) {
      double value = 0.0;
      for (std::size_t j = column; j < n; ++j) {
        value += inverse[row * n + j] * inverse[column * n + j];
      }
      c[row * n + column] = value;
      c[column * n + row] = value;
    }
  }
  return Status::ok;
}

Observability StreamingLeastSquaresCore::observability(std::span<const double> scale,
                                                       double tolerance) const {
  const std::size_t n = unknowns_;
  std::array<double, kMaxUnknowns * kMaxUnknowns> a{};
  std::array<double, kMaxUnknowns * kMaxUnknowns> v{};
  for (std::size_t row = 0; row < n; ++row) {
    for (std::size_t column = row; column < n; ++column) {
      a[column * n + row] = factor(row, column) * (scale.empty() ? 1.0 : scale[column]);
    }
  }
  Observability result;
  result.unknowns = n;
  // Sizes agree and an unfinished sweep still leaves usable values: nothing here can fail.
  static_cast<void>(jacobi_svd(std::span{a}.first(n * n), n, n, std::span{v}.first(n * n),
                               std::span{result.singular_values}.first(n)));
  const double largest = result.singular_values[0];
  const double smallest = result.singular_values[n - 1];
  for (std::size_t k = 0; k < n; ++k) {
    if (largest > 0.0 && result.singular_values[k] > tolerance * largest) { ++result.rank; }
    result.weakest[k] = v[(n - 1) * n + k];
  }
  result.condition = smallest > 0.0 ? largest / smallest : std::numeric_limits<double>::infinity();
  return result;
}

}  // namespace picolo::inline v0
