// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Least squares by normal equations and LDL^T: the cheapest of the three classical ways; squares
/// the condition number. Also the small symmetric inverse that turns an information matrix into a
/// covariance.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"
#include "picolo/solve/streaming_least_squares.hpp"

namespace picolo::inline v0 {

/// Solves the symmetric positive definite system m x = b, row-major n x n, n <= kMaxUnknowns, by
/// LDL^T without pivoting. `degenerate`: a pivot is not above 1e-15 of its diagonal element; x is
/// unchanged. Cost: n^3 / 6.
Status solve_symmetric(std::span<const double> m, std::span<const double> b, std::span<double> x);
/// The inverse of a symmetric positive definite matrix, symmetric to the last bit. Status as above.
/// Cost: n^3. The matrix is first scaled to a unit diagonal, so that units of unknowns may differ
/// by many orders of magnitude.
Status invert_symmetric(std::span<const double> m, std::span<double> inverse);

/// Sums A^T A and A^T b row by row. Memory does not depend on the number of rows. Context: one at a
/// time.
class NormalLeastSquares {
 public:
  /// Precondition: 1 <= unknowns <= kMaxUnknowns.
  explicit NormalLeastSquares(std::size_t unknowns) : unknowns_(unknowns) {}

  void reset();
  /// Cost: O(unknowns^2) multiplications, no square root, no division. Status as
  /// StreamingLeastSquaresCore::add.
  Status add(std::span<const double> a, double b, double weight = 1.0);
  Status solve(std::span<double> x) const;
  Status covariance(std::span<double> c) const;
  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  [[nodiscard]] std::span<const double> information() const {
    return std::span{matrix_}.first(unknowns_ * unknowns_);
  }

 private:
  std::size_t unknowns_;
  std::uint64_t rows_ = 0;
  std::array<double, kMaxUnknowns * kMaxUnknowns> matrix_{};
  std::array<double, kMaxUnknowns> right_{};
};

}  // namespace picolo::inline v0
