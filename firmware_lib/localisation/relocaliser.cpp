// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/localisation/relocaliser.hpp"

#include <algorithm>
#include <numbers>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"

namespace picolo::inline v0 {
namespace {

constexpr int kLevels = kMaxPyramidLevels;
constexpr int kCoarseShift = 2;
constexpr int kCoarseCells = 1 << kCoarseShift;
constexpr int kSurveyRows = 8;  // of the coarse map, in one step
constexpr int kTopCells = MaxPyramidView::size_of(kLevels - 1);
constexpr int kMaxHalfCells = (static_cast<int>(PoseSearch::kMaxRowSquares) - 1) * kTopCells / 2;

static_assert(kTileCells % kTopCells == 0, "a window of whole tiles has whole squares");

MaxPyramidCore pyramid_in(std::span<std::uint8_t> memory, const GridWindow& window) {
  std::array<std::span<std::uint8_t>, kMaxPyramidLevels> levels{};
  const std::size_t cells =
      static_cast<std::size_t>(window.width) * static_cast<std::size_t>(window.height);
  std::size_t begin = 0;
  for (int level = 0; level < kLevels; ++level) {
    const auto side = static_cast<std::size_t>(MaxPyramidView::size_of(level));
    const std::size_t bytes = cells / (side * side);
    levels[static_cast<std::size_t>(level)] = memory.subspan(begin, bytes);
    begin += bytes;  // 21/256 of a byte a cell in all; 32/256 are lent
  }
  return {window.width, window.height, kLevels, levels};
}

}  // namespace

bool RelocaliseConfig::as_good(float agreement, float best) const {
  return 1.0F - agreement < 2.0F * (1.0F - best) + rival_margin;
}

Relocaliser::Relocaliser(const RelocaliseConfig& config, RollingMapCore& fine,
                         const RollingMapCore& coarse)
    : config_(config),
      fine_(fine),
      coarse_(coarse),
      pyramid_(pyramid_in(fine.lend_scan_memory(), fine.window())) {}

bool Relocaliser::begin(const PointsView& points) {
  found_ = 0;
  nodes_ = 0;
  exact_ = false;
  if (points.size() < config_.min_points) { return false; }
  points_ = points;
  (void)fine_.lend_scan_memory();
  pyramid_.begin(fine_.field());
  row_ = 0;
  first_column_ = coarse_.window().width;
  last_column_ = -1;
  first_row_ = coarse_.window().height;
  last_row_ = -1;
  phase_ = Phase::surveying;
  return true;
}

void Relocaliser::survey_row() {
  const int width = coarse_.window().width;
  const auto begin = static_cast<std::size_t>(row_) * static_cast<std::size_t>(width);
  const auto line = coarse_.occupancy().subspan(begin, static_cast<std::size_t>(width));
  for (int column = 0; column < width; ++column) {
    if (line[static_cast<std::size_t>(column)] >= 0) { continue; }
    first_column_ = std::min(first_column_, column);
    last_column_ = std::max(last_column_, column);
    first_row_ = std::min(first_row_, row_);
    last_row_ = row_;
  }
  ++row_;
}

bool Relocaliser::begin_search(PoseSearch& search) {
  const GridWindow& fine = fine_.window();
  const GridWindow& coarse = coarse_.window();
  const PoseSearchArea area{.log_odds = coarse_.occupancy().data(),
                            .width = coarse.width,
                            .height = coarse.height,
                            .shift = kCoarseShift,
                            .offset_x = fine.origin_x_cells - coarse.origin_x_cells * kCoarseCells,
                            .offset_y = fine.origin_y_cells - coarse.origin_y_cells * kCoarseCells};
  // The square around the free cells and one more on each side, in cells of the fine map.
  const int middle_x = (first_column_ + last_column_ + 1) * kCoarseCells / 2 - area.offset_x;
  const int middle_y = (first_row_ + last_row_ + 1) * kCoarseCells / 2 - area.offset_y;
  const int longer = std::max(last_column_ - first_column_, last_row_ - first_row_) + 1;
  const int half = std::min((longer / 2 + 2) * kCoarseCells, kMaxHalfCells);
  const SearchWindow window{.centre = {(static_cast<float>(middle_x) + 0.5F) * fine.cell_m,
                                       (static_cast<float>(middle_y) + 0.5F) * fine.cell_m, 0.0F},
                            .half_translation_m = static_cast<float>(half) * fine.cell_m,
                            .half_rotation_rad = std::numbers::pi_v<float>};
  return search.begin(fine_.field(), pyramid_.view(), points_, window, {}, area) == Status::ok;
}

void Relocaliser::end_search(PoseSearch& search) {
  const PoseSearchReport report = search.report();
  nodes_ = report.nodes;
  if (report.found) {
    places_[found_] = report.best;
    ++found_;
  }
  exact_ = report.exact;
  if (phase_ == Phase::rival || !report.found || !report.exact) {
    phase_ = Phase::over;
    return;
  }
  search.begin_elsewhere({report.best.pose, config_.apart_m, config_.apart_rad},
                         config_.rival_score * report.best.score);
  phase_ = Phase::rival;
}

bool Relocaliser::apart(const Pose2f& a, const Pose2f& b) const {
  const float turn_rad = wrap_angle(a.theta_rad - b.theta_rad);
  return hypotenuse(a.x_m - b.x_m, a.y_m - b.y_m) > config_.apart_m ||
         turn_rad > config_.apart_rad || turn_rad < -config_.apart_rad;
}

bool Relocaliser::step(PoseSearch& search) {
  switch (phase_) {
    case Phase::over: break;
    case Phase::surveying:
      for (int k = 0; k < kSurveyRows && row_ < coarse_.window().height; ++k) { survey_row(); }
      if (row_ == coarse_.window().height) {
        phase_ = last_row_ < 0 ? Phase::over : Phase::building;
      }
      break;
    case Phase::building:
      if (!pyramid_.step(1)) { break; }
      phase_ = begin_search(search) ? Phase::best : Phase::over;
      break;
    case Phase::best:
    case Phase::rival:
      if (search.step(config_.nodes_per_step)) { end_search(search); }
      break;
  }
  return phase_ == Phase::over;
}

}  // namespace picolo::inline v0
