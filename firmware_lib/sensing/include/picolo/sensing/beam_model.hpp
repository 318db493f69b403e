// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How likely a range is where another one was expected (Thrun, Burgard, Fox 2005, "Probabilistic
/// robotics", section 6.3), and how the parameters are learnt from recorded ranges.
#pragma once

#include <cstddef>
#include <span>

#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// A mixture of four causes; the weights sum to 1.
struct BeamModel {
  float hit_weight = 0.75F;       ///< Gaussian around the expected range
  float short_weight = 0.1F;      ///< exponential in front of it: unexpected objects
  float max_weight = 0.05F;       ///< nothing came back: a mass at the maximum
  float random_weight = 0.1F;     ///< uniform over all ranges
  float sigma_m = 0.05F;          ///< of the Gaussian
  float short_rate_per_m = 0.5F;  ///< of the exponential
  float max_range_m = 30.0F;      ///< readings from here on, and 0, are failures
  [[nodiscard]] constexpr bool valid() const {
    return hit_weight >= 0.0F && short_weight >= 0.0F && max_weight >= 0.0F &&
           random_weight >= 0.0F && sigma_m > 0.0F && short_rate_per_m > 0.0F && max_range_m > 0.0F;
  }
};
static_assert(BeamModel{}.valid());

/// One beam: what was read, and what the map says it should have been.
struct BeamPair {
  float measured_m = 0.0F;
  float expected_m = 0.0F;
};

/// p(measured | expected): a density in 1/m within the range, a probability for a failure (a
/// reading of 0, not finite, or from max_range_m on). The Gaussian is not cut off at 0. Cost: two
/// exponentials. Context: any.
[[nodiscard]] float beam_likelihood(const BeamModel& model, const BeamPair& pair);

/// Sum of log likelihoods, beams taken as independent; a beam counts at least log(1e-9). Pairs
/// whose expected range is not in (0, max_range_m) are left out. Cost: O(pairs).
[[nodiscard]] float scan_log_likelihood(const BeamModel& model, std::span<const BeamPair> pairs);

struct BeamFitConfig {
  int max_iterations = 200;
  std::size_t min_pairs = 200;
  float converged = 1e-6F;    ///< stop when no weight, and neither sigma nor rate by its own size,
                              ///< changes by more
  float min_sigma_m = 1e-3F;  ///< a cluster of identical ranges must not swallow the mixture
  [[nodiscard]] constexpr bool valid() const {
    return max_iterations > 0 && min_pairs > 0 && converged > 0.0F && min_sigma_m > 0.0F;
  }
};
static_assert(BeamFitConfig{}.valid());

struct BeamFitReport {
  BeamModel model{};
  double mean_log_likelihood = 0.0;  ///< of the model before the last iteration
  std::size_t pairs = 0;             ///< that took part
  int iterations = 0;
  bool converged = false;
};

/// Expectation maximisation (table 6.2 there), with the exponential's M-step corrected for its end
/// at the expected range. Resumable: `begin`, then `step` until true; every iteration raises the
/// likelihood. In double: it is a calibration. Context: cycle or host.
class BeamModelFit {
 public:
  explicit BeamModelFit(const BeamFitConfig& config = {}) : config_(config) {}

  /// `pairs` must stay valid until the last step. `start`: first guess, its weights all above 0;
  /// max_range_m is kept. `invalid_argument`: configuration or guess; `degenerate`: fewer than
  /// min_pairs pairs with an expected range.
  Status begin(std::span<const BeamPair> pairs, const BeamModel& start = {});
  /// One iteration over all pairs; true when the report is final. Cost: about 300 instructions a
  /// pair.
  bool step();
  [[nodiscard]] const BeamFitReport& report() const { return report_; }

 private:
  BeamFitConfig config_;
  std::span<const BeamPair> pairs_{};
  BeamFitReport report_{};
  bool done_ = true;
};

}  // namespace picolo::inline v0
