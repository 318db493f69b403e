// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Scan to scan by point-to-line ICP (Censi 2008, "An ICP variant using a point-to-line metric"),
/// trimmed: quadratic convergence where point-to-point crawls along walls. Lines are fitted through
/// several neighbours: two adjacent beams of a near wall stand closer together than their noise,
/// and a line through them points anywhere.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/matching/match_report.hpp"
#include "picolo/solve/normal_equations.hpp"

namespace picolo::inline v0 {

struct PlIcpConfig {
  int max_iterations = 30;
  int min_pairs = 30;
  float max_pair_m = 0.4F;         ///< points further from the reference have no partner
  float max_segment_m = 0.3F;      ///< neighbours of the reference further apart are no line...
  float max_segment_share = 0.1F;  ///< ... unless closer than this share of their range
  float line_radius_m = 0.04F;     ///< a line is fitted through neighbours within this radius...
  int line_neighbours = 3;         ///< ... at most so many on each side
  float max_flatness = 0.5F;       ///< smaller over larger spread; above: a corner, no line
  float keep_share = 0.95F;        ///< of the pairs, those with the smallest distance to their line
  int max_candidates = 60;         ///< reference points looked at on each side of a bearing
  float converged_m = 1e-4F;       ///< stop when the step is below both
  float converged_rad = 1e-4F;
  float max_total_m = 1.0F;  ///< from the start; beyond: step_limit
  float max_total_rad = 0.8F;
  float max_condition = 1000.0F;
  float sigma_m = 0.02F;  ///< of one distance to a line, at least; larger when the residuals are
  [[nodiscard]] constexpr bool valid() const {
    return max_iterations > 0 && min_pairs >= 3 && max_pair_m > 0.0F && max_segment_m > 0.0F &&
           max_segment_share >= 0.0F && line_radius_m > 0.0F && line_neighbours >= 1 &&
           max_flatness > 0.0F && keep_share > 0.0F && keep_share <= 1.0F && max_candidates > 0 &&
           converged_m > 0.0F && converged_rad > 0.0F && max_total_m > 0.0F &&
           max_total_rad > 0.0F && max_condition > 1.0F && sigma_m > 0.0F;
  }
};
static_assert(PlIcpConfig{}.valid());

/// The line through a reference point and its neighbours.
struct ReferenceLine {
  Point2f anchor_m{};
  Point2f normal{};  ///< unit; zero: no line here
};

/// One scan point and the line it should lie on.
struct LinePair {
  std::uint16_t point = 0;
  Point2f normal{};         ///< unit, in the reference frame
  float distance_m = 0.0F;  ///< of the transformed point to the line, signed
};

/// Working memory: one element a reference point, and one a scan point.
struct PlIcpStorage {
  std::span<std::uint16_t> by_bearing;
  std::span<float> bearing_rad;
  std::span<ReferenceLine> lines;
  std::span<LinePair> pairs;
  std::span<float> sorted_m;
};

/// Same calls and report as the matchers on maps; poses are in the frame of the reference scan,
/// whose origin must be the sensor (partners are looked for by bearing). With a prior it alone
/// decides along directions that the scan leaves open; without one the start does. Equal distances:
/// the lower index. Cost: an iteration O(scan points * max_candidates), one arc tangent a point.
/// Context: cycle only.
class PlIcpMatcherCore {
 public:
  PlIcpMatcherCore(const PlIcpConfig& config, const PlIcpStorage& storage)
      : config_(config), storage_(storage) {}

  /// `reference` must stay valid until the report. Points beyond the storage are left out.
  void begin(const PointsView& reference, const MatchRequest& request);
  /// One iteration: partners, trimming, one Gauss-Newton step. True when the report is final.
  bool step();
  /// The same in slices, to the same bits: what `begin` does is left to the first calls of
  /// `step_slice`, each of which takes as long as about `max_looks` looks at a reference point, or
  /// does one piece that takes longer: sorting by bearing, the solution of a step. True when the
  /// report is final.
  void begin_slices(const PointsView& reference, const MatchRequest& request);
  bool step_slice(std::size_t max_looks);
  [[nodiscard]] const MatchReport& report() const { return report_; }
  [[nodiscard]] bool done() const { return done_; }
  [[nodiscard]] MatchReport match(const PointsView& reference, const MatchRequest& request);

 private:
  struct Partner {
    std::size_t position = 0;  // in the order of bearing
    float squared_m2 = 0.0F;
    std::size_t looks = 0;
    bool found = false;
  };
  /// What the next slice goes on with.
  enum class Stage : std::uint8_t { bearings, order, lines, pairs, solution };
  [[nodiscard]] Point2f reference_at(std::size_t position) const;
  [[nodiscard]] Partner nearest(const Point2f& p) const;
  [[nodiscard]] ReferenceLine line_at(std::size_t position) const;
  [[nodiscard]] std::size_t neighbours(std::size_t position, bool upwards) const;
  [[nodiscard]] std::size_t least_looks() const;
  std::size_t do_piece(std::size_t max_looks);
  std::size_t find_bearings(std::size_t max_looks);
  void order_by_bearing();
  std::size_t find_lines(std::size_t max_looks);
  std::size_t find_pairs(std::size_t max_looks);
  bool solve_step();
  [[nodiscard]] float trim_limit();
  [[nodiscard]] NormalEquations3 linearise(float limit_m, float& mean_squares, int& used) const;
  bool finish(MatchOutcome outcome);

  PlIcpConfig config_;
  PlIcpStorage storage_;
  PointsView reference_{};
  MatchRequest request_{};
  MatchReport report_{};
  std::size_t reference_count_ = 0;
  std::size_t scan_count_ = 0;
  std::size_t pair_count_ = 0;
  std::size_t next_ = 0;  // of the stage's points
  Stage stage_ = Stage::bearings;
  bool done_ = true;
};

/// Storage: 42 bytes a point.
template <std::size_t Capacity>
class PlIcpMatcher {
  static_assert(Capacity > 0 && Capacity < 65536);

 public:
  explicit PlIcpMatcher(const PlIcpConfig& config = {})
      : core_(config, {by_bearing_, bearing_rad_, lines_, pairs_, sorted_m_}) {}
  PlIcpMatcher(const PlIcpMatcher&) = delete;
  PlIcpMatcher& operator=(const PlIcpMatcher&) = delete;
  ~PlIcpMatcher() = default;

  [[nodiscard]] PlIcpMatcherCore& core() { return core_; }
  [[nodiscard]] MatchReport match(const PointsView& reference, const MatchRequest& request) {
    return core_.match(reference, request);
  }

 private:
  std::array<std::uint16_t, Capacity> by_bearing_{};
  std::array<float, Capacity> bearing_rad_{};
  std::array<ReferenceLine, Capacity> lines_{};
  std::array<LinePair, Capacity> pairs_{};
  std::array<float, Capacity> sorted_m_{};
  PlIcpMatcherCore core_;
};

}  // namespace picolo::inline v0
