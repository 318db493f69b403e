// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What is said about a set of errors. Context: any.
#pragma once

#include <cstddef>
#include <span>

#include "picolo/core/result.hpp"

namespace picolo::inline v0 {

/// All in the unit of the errors, except `sse` (squared) and `count`.
struct ErrorStatistics {
  double rmse{};
  double mean{};
  double median{};  ///< mean of the two middle errors for an even count
  double std{};     ///< of the population: divided by count
  double min{};
  double max{};
  double sse{};  ///< sum of squared errors
  std::size_t count{};
};

/// All figures in one pass over errors that are at hand; sorts `errors`, which the median needs.
/// `invalid_argument` when empty or not finite. Cost: O(n log n).
[[nodiscard]] Result<ErrorStatistics> statistics_of(std::span<double> errors);

/// The same figures, but for the median, from errors that come one by one (Welford 1962); O(1)
/// memory, for the target.
class RunningStatistics {
 public:
  /// Cost: O(1). A value that is not finite is counted in `rejected()` and left out.
  void add(double error);
  /// `not_ready` before the first error. `median` is 0.
  [[nodiscard]] Result<ErrorStatistics> report() const;
  [[nodiscard]] std::size_t rejected() const { return rejected_; }

 private:
  std::size_t count_ = 0;
  std::size_t rejected_ = 0;
  double mean_ = 0.0;
  double spread_ = 0.0;
  double sse_ = 0.0;
  double min_ = 0.0;
  double max_ = 0.0;
};

}  // namespace picolo::inline v0
