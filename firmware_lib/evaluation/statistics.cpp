// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/evaluation/statistics.hpp"

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

double middle_of(std::span<const double> sorted) {
  const std::size_t half = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2.0;
}

}  // namespace

Result<ErrorStatistics> statistics_of(std::span<double> errors) {
  if (errors.empty() ||
      !std::all_of(errors.begin(), errors.end(), [](double e) { return is_finite(e); })) {
    return Status::invalid_argument;
  }
  std::sort(errors.begin(), errors.end());
  const auto count = static_cast<double>(errors.size());
  double sum = 0.0;
  double sse = 0.0;
  for (const double error : errors) {  // ascending, so small ones are not lost against large ones
    sum += error;
    sse += error * error;
  }
  const double mean = sum / count;
  double spread = 0.0;
  for (const double error : errors) { spread += (error - mean) * (error - mean); }
  return ErrorStatistics{.rmse = square_root(sse / count),
                         .mean = mean,
                         .median = middle_of(errors),
                         .std = square_root(spread / count),
                         .min = errors.front(),
                         .max = errors.back(),
                         .sse = sse,
                         .count = errors.size()};
}

void RunningStatistics::add(double error) {
  if (!is_finite(error)) {
    ++rejected_;
    return;
  }
  min_ = count_ == 0 || error < min_ ? error : min_;
  max_ = count_ == 0 || error > max_ ? error : max_;
  ++count_;
  const double before = error - mean_;
  mean_ += before / static_cast<double>(count_);
  spread_ += before * (error - mean_);
  sse_ += error * error;
}

Result<ErrorStatistics> RunningStatistics::report() const {
  if (count_ == 0) { return Status::not_ready; }
  const auto count = static_cast<double>(count_);
  return ErrorStatistics{.rmse = square_root(sse_ / count),
                         .mean = mean_,
                         .median = 0.0,
                         .std = square_root(spread_ / count),
                         .min = min_,
                         .max = max_,
                         .sse = sse_,
                         .count = count_};
}

}  // namespace picolo::inline v0
