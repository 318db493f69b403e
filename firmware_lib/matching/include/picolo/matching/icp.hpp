// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Scan to scan by iterated closest points (Besl and McKay 1992), trimmed (Chetverikov, Svirko,
/// Stepanov, Krsek 2002).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/matching/match_report.hpp"

namespace picolo::inline v0 {

struct IcpConfig {
  int max_iterations = 40;
  int min_pairs = 30;
  float max_pair_m = 0.5F;         ///< points further from the reference have no partner
  float keep_share = 0.9F;         ///< of the pairs, the closest ones
  float converged_m = 1e-4F;       ///< stop when the step is below both
  float converged_rad = 1.75e-5F;  ///< 0.001 deg
  float max_total_m = 1.0F;        ///< from the start; beyond: step_limit
  float max_total_rad = 0.6F;
  float max_condition = 1000.0F;
  float sigma_m = 0.03F;  ///< of one pair's distance
  float effective_points = 60.0F;
  [[nodiscard]] constexpr bool valid() const {
    return max_iterations > 0 && min_pairs >= 3 && max_pair_m > 0.0F && keep_share > 0.0F &&
           keep_share <= 1.0F && converged_m > 0.0F && converged_rad > 0.0F && max_total_m > 0.0F &&
           max_total_rad > 0.0F && max_condition > 1.0F && sigma_m > 0.0F &&
           effective_points > 0.0F;
  }
};
static_assert(IcpConfig{}.valid());

/// Working memory, one element a point.
struct IcpStorage {
  std::span<std::uint16_t> by_x;     ///< reference points in the order of x
  std::span<std::uint16_t> partner;  ///< of each scan point
  std::span<float> squared_m2;       ///< distance to it; negative: none
  std::span<float> sorted_m2;
};

/// Same calls and report as the matchers on maps; poses are in the frame of the reference scan, the
/// request's prior is not used. Partners are found exactly, in a list of the reference sorted by x.
/// Equal distances: the lower index. Cost: an iteration about O(points * sqrt(points)), at worst
/// O(points^2). Context: cycle only.
class IcpMatcherCore {
 public:
  IcpMatcherCore(const IcpConfig& config, const IcpStorage& storage)
      : config_(config), storage_(storage) {}

  /// `reference` must stay valid until the report. Points beyond the storage are left out.
  void begin(const PointsView& reference, const MatchRequest& request);
  /// One iteration: partners, trimming, closed-form motion. True when the report is final.
  bool step();
  [[nodiscard]] const MatchReport& report() const { return report_; }
  [[nodiscard]] bool done() const { return done_; }
  [[nodiscard]] MatchReport match(const PointsView& reference, const MatchRequest& request);

 private:
  [[nodiscard]] std::size_t find_partners();
  [[nodiscard]] float trim_limit(std::size_t pairs);
  [[nodiscard]] bool improve(float limit_m2, Pose2f& pose);
  bool finish(MatchOutcome outcome);

  IcpConfig config_;
  IcpStorage storage_;
  PointsView reference_{};
  MatchRequest request_{};
  MatchReport report_{};
  std::size_t reference_count_ = 0;
  std::size_t scan_count_ = 0;
  bool done_ = true;
};

/// Storage: 12 bytes a point.
template <std::size_t Capacity>
class IcpMatcher {
  static_assert(Capacity > 0 && Capacity < 65536);

 public:
  explicit IcpMatcher(const IcpConfig& config = {})
      : core_(config, {by_x_, partner_, squared_m2_, sorted_m2_}) {}
  IcpMatcher(const IcpMatcher&) = delete;
  IcpMatcher& operator=(const IcpMatcher&) = delete;
  ~IcpMatcher() = default;

  [[nodiscard]] IcpMatcherCore& core() { return core_; }
  [[nodiscard]] MatchReport match(const PointsView& reference, const MatchRequest& request) {
    return core_.match(reference, request);
  }

 private:
  std::array<std::uint16_t, Capacity> by_x_{};
  std::array<std::uint16_t, Capacity> partner_{};
  std::array<float, Capacity> squared_m2_{};
  std::array<float, Capacity> sorted_m2_{};
  IcpMatcherCore core_;
};

}  // namespace picolo::inline v0
