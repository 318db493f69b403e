// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Least squares in constant memory: rows are folded one by one into a square-root information by
/// Givens rotations, so the condition number of the problem enters once, not squared as in normal
/// equations (Golub, van Loan, "Matrix computations", 5.2, 6.1).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// The largest number of unknowns of any solver of this folder that works on spans.
inline constexpr std::size_t kMaxUnknowns = 9;

/// What the rows gathered so far determine, and what not. Directions are unit vectors in scaled
/// unknowns x_i / scale_i.
struct Observability {
  std::size_t unknowns = 0;
  std::size_t rank = 0;  ///< singular values above the tolerance
  /// Largest over smallest singular value; infinity when the smallest is 0.
  double condition = 0.0;
  std::array<double, kMaxUnknowns> singular_values{};  ///< descending
  std::array<double, kMaxUnknowns>
      weakest{};  ///< right singular vector of the smallest singular value
  /// The unknown with the largest part in `weakest`; the first one when several are equal.
  [[nodiscard]] std::size_t weakest_unknown() const;
};

/// Doubles that n unknowns need: the upper triangle of R and d.
[[nodiscard]] constexpr std::size_t square_root_size(std::size_t unknowns) {
  return unknowns * (unknowns + 1) / 2 + unknowns;
}

/// The logic behind `StreamingLeastSquares`, over storage it does not own: minimises sum w_k^2 (a_k
/// x - b_k)^2 over x. Memory does not depend on the number of rows. Context: one at a time.
class StreamingLeastSquaresCore {
 public:
  /// Precondition: 1 <= unknowns <= kMaxUnknowns and storage.size() >= square_root_size(unknowns).
  StreamingLeastSquaresCore(std::span<double> storage, std::size_t unknowns);

  void reset();
  /// Folds the row a x = b with weight w (1 / sigma of b). Cost: O(unknowns^2), one square root an
  /// unknown. `invalid_argument`: wrong length, or a number that is not finite; nothing was
  /// changed.
  Status add(std::span<const double> a, double b, double weight = 1.0);
  /// As if all rows of the other had been added here too. `invalid_argument`: another number of
  /// unknowns.
  Status merge(const StreamingLeastSquaresCore& other);

  /// The minimiser. `degenerate`: rows do not determine it (a pivot below 1e-13 of the largest); x
  /// is unchanged.
  Status solve(std::span<double> x) const;
  /// (A^T W^2 A)^-1, row-major n x n: the covariance of the minimiser when weights are 1 / sigma,
  /// else times sigma^2. `degenerate` as above.
  Status covariance(std::span<double> c) const;
  /// Singular values of R diag(scale) by one-sided Jacobi. `scale`: the size of one step of each
  /// unknown that matters equally (empty: ones). A direction counts into the rank when its singular
  /// value exceeds `tolerance` times the largest. Cost: O(unknowns^3) a sweep, at most 30 sweeps.
  [[nodiscard]] Observability observability(std::span<const double> scale = {},
                                            double tolerance = 1e-10) const;

  [[nodiscard]] std::uint64_t rows() const { return rows_; }
  [[nodiscard]] std::size_t unknowns() const { return unknowns_; }
  /// Weighted sum of squared residuals at the minimiser.
  [[nodiscard]] double residual_squares() const { return residual_squares_; }
  /// R(row, column) of the square-root information, column >= row.
  [[nodiscard]] double factor(std::size_t row, std::size_t column) const {
    return storage_[index(row, column)];
  }

 private:
  [[nodiscard]] std::size_t index(std::size_t row, std::size_t column) const {
    return row * (2 * unknowns_ - row - 1) / 2 + column;
  }
  [[nodiscard]] std::size_t right_hand(std::size_t row) const {
    return unknowns_ * (unknowns_ + 1) / 2 + row;
  }
  [[nodiscard]] bool determined() const;
  void fold(std::span<double> row, double value);

  std::span<double> storage_;
  std::size_t unknowns_;
  std::uint64_t rows_ = 0;
  double residual_squares_ = 0.0;
};

/// Storage: 8 * square_root_size(Unknowns) bytes, 432 for nine unknowns.
template <std::size_t Unknowns>
class StreamingLeastSquares {
  static_assert(Unknowns >= 1 && Unknowns <= kMaxUnknowns);

 public:
  StreamingLeastSquares() : core_(storage_, Unknowns) {}
  StreamingLeastSquares(const StreamingLeastSquares&) = delete;
  StreamingLeastSquares& operator=(const StreamingLeastSquares&) = delete;
  ~StreamingLeastSquares() = default;

  [[nodiscard]] StreamingLeastSquaresCore& core() { return core_; }
  [[nodiscard]] const StreamingLeastSquaresCore& core() const { return core_; }
  void reset() { core_.reset(); }
  Status add(const std::array<double, Unknowns>& a, double b, double weight = 1.0) {
    return core_.add(a, b, weight);
  }
  Status solve(std::array<double, Unknowns>& x) const { return core_.solve(x); }
  Status covariance(std::array<double, Unknowns * Unknowns>& c) const {
    return core_.covariance(c);
  }

 private:
  std::array<double, square_root_size(Unknowns)> storage_{};
  StreamingLeastSquaresCore core_;
};

}  // namespace picolo::inline v0
