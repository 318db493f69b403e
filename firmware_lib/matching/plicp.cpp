// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/matching/plicp.hpp"

#include <algorithm>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "pose_steps.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kAllLooks = 1U << 30;
// What else is done, in looks that take as long.
constexpr std::size_t kLooksPerBearing = 4;
constexpr std::size_t kLooksPerLine = 24;
constexpr std::size_t kLooksPerPoint = 10;
constexpr std::size_t kLooksPerSorted = 8;
constexpr std::size_t kLooksPerPair = 3;

float squared_distance(const Point2f& a, const Point2f& b) {
  return square(a.x_m - b.x_m) + square(a.y_m - b.y_m);
}

}  // namespace

void PlIcpMatcherCore::begin(const PointsView& reference, const MatchRequest& request) {
  begin_slices(reference, request);
  while (!done_ && stage_ != Stage::pairs) { static_cast<void>(do_piece(kAllLooks)); }
}

void PlIcpMatcherCore::begin_slices(const PointsView& reference, const MatchRequest& request) {
  reference_ = reference;
  request_ = request;
  report_ = MatchReport{};
  report_.pose = request.start;
  reference_count_ = std::min(reference.size(), storage_.by_bearing.size());
  scan_count_ = std::min(request.points.size(), storage_.pairs.size());
  next_ = 0;
  stage_ = Stage::bearings;
  done_ = false;
  const auto needed = static_cast<std::size_t>(config_.min_pairs);
  if (reference_count_ < needed || scan_count_ < needed) {
    static_cast<void>(finish(MatchOutcome::too_few_points));
  }
}

bool PlIcpMatcherCore::step() {
  bool iterated = false;
  while (!done_ && !iterated) {
    iterated = stage_ == Stage::solution;
    static_cast<void>(do_piece(kAllLooks));
  }
  return done_;
}

bool PlIcpMatcherCore::step_slice(std::size_t max_looks) {
  std::size_t looks = 0;
  while (!done_ && (looks == 0 || looks + least_looks() <= max_looks)) {
    looks += do_piece(max_looks > looks ? max_looks - looks : 1);
  }
  return done_;
}

/// What the next piece takes at least.
std::size_t PlIcpMatcherCore::least_looks() const {
  switch (stage_) {
    case Stage::bearings: return kLooksPerBearing;
    case Stage::order: return kLooksPerSorted * reference_count_;
    case Stage::lines: return kLooksPerLine;
    case Stage::pairs: return kLooksPerPoint + 2 * static_cast<std::size_t>(config_.max_candidates);
    case Stage::solution: break;
  }
  return kLooksPerPair * scan_count_;
}

/// Returns the looks that it took.
std::size_t PlIcpMatcherCore::do_piece(std::size_t max_looks) {
  const std::size_t least = least_looks();
  switch (stage_) {
    case Stage::bearings: return find_bearings(max_looks);
    case Stage::order: order_by_bearing(); return least;
    case Stage::lines: return find_lines(max_looks);
    case Stage::pairs: return find_pairs(max_looks);
    case Stage::solution: break;
  }
  next_ = 0;
  stage_ = Stage::pairs;
  done_ = solve_step();
  return least;
}

/// By original index: the key to sort by.
std::size_t PlIcpMatcherCore::find_bearings(std::size_t max_looks) {
  const std::size_t most = std::max<std::size_t>(1, max_looks / kLooksPerBearing);
  const std::size_t count = std::min(most, reference_count_ - next_);
  for (const std::size_t end = next_ + count; next_ < end; ++next_) {
    storage_.by_bearing[next_] = static_cast<std::uint16_t>(next_);
    storage_.sorted_m[next_] = arc_tangent2(reference_.y_m[next_], reference_.x_m[next_]);
  }
  if (next_ == reference_count_) { stage_ = Stage::order; }
  return count * kLooksPerBearing;
}

void PlIcpMatcherCore::order_by_bearing() {
  const std::span<std::uint16_t> order = storage_.by_bearing.first(reference_count_);
  const std::span<const float> key = storage_.sorted_m;
  std::sort(order.begin(), order.end(), [key](std::uint16_t a, std::uint16_t b) {
    return key[a] < key[b] || (key[a] == key[b] && a < b);
  });
  for (std::size_t k = 0; k < reference_count_; ++k) { storage_.bearing_rad[k] = key[order[k]]; }
  next_ = 0;
  stage_ = Stage::lines;
}

std::size_t PlIcpMatcherCore::find_lines(std::size_t max_looks) {
  const std::size_t most = std::max<std::size_t>(1, max_looks / kLooksPerLine);
  const std::size_t count = std::min(most, reference_count_ - next_);
  for (const std::size_t end = next_ + count; next_ < end; ++next_) {
    storage_.lines[next_] = line_at(next_);
  }
  if (next_ == reference_count_) {
    next_ = 0;
    stage_ = Stage::pairs;
  }
  return count * kLooksPerLine;
}

Point2f PlIcpMatcherCore::reference_at(std::size_t position) const {
  const std::size_t index = storage_.by_bearing[position];
  return {reference_.x_m[index], reference_.y_m[index]};
}

/// Walks both ways from the point's bearing. No reference point at an angle d away is nearer than r
/// sin d, so a side ends there.
PlIcpMatcherCore::Partner PlIcpMatcherCore::nearest(const Point2f& p) const {
  const float bearing = arc_tangent2(p.y_m, p.x_m);
  const float range = hypotenuse(p.x_m, p.y_m);
  const std::span<const float> bearings = storage_.bearing_rad.first(reference_count_);
  const auto middle = static_cast<std::size_t>(
      std::lower_bound(bearings.begin(), bearings.end(), bearing) - bearings.begin());
  Partner best;
  best.squared_m2 = square(config_.max_pair_m);
  std::size_t looks = 0;
  const auto look = [&](std::size_t position) {
    ++looks;
    const float angle = magnitude(wrap_angle(bearings[position] - bearing));
    // sin d >= 2 d / pi below a right angle
    if (angle < 1.5F && square(range * angle * 0.6366F) > best.squared_m2) { return false; }
    const float squared = squared_distance(reference_at(position), p);
    if (squared < best.squared_m2) { best = {position, squared, 0, true}; }
    return true;
  };
  const auto candidates = static_cast<std::size_t>(config_.max_candidates);
  const std::size_t most = std::min(candidates, reference_count_ / 2);
  std::size_t up = middle < reference_count_ ? middle : 0;
  for (std::size_t k = 0; k < most && look(up); ++k) {
    up = up + 1 < reference_count_ ? up + 1 : 0;
  }
  std::size_t down = middle > 0 ? middle - 1 : reference_count_ - 1;
  for (std::size_t k = 0; k < most && look(down); ++k) {
    down = down > 0 ? down - 1 : reference_count_ - 1;
  }
  best.looks = looks;
  return best;
}

/// How many neighbours on one side belong to the same surface.
std::size_t PlIcpMatcherCore::neighbours(std::size_t position, bool upwards) const {
  const Point2f q = reference_at(position);
  const float gap =
      square(std::max(config_.max_segment_m, config_.max_segment_share * hypotenuse(q.x_m, q.y_m)));
  Point2f before = q;
  std::size_t count = 0;
  for (int k = 1; k <= config_.line_neighbours; ++k) {
    const auto offset = static_cast<std::size_t>(k);
    const Point2f next = reference_at((position + (upwards ? offset : reference_count_ - offset)) %
                                      reference_count_);
    const bool near = squared_distance(next, q) <= square(config_.line_radius_m);
    if (squared_distance(next, before) > gap || (k > 1 && !near)) {
      break;
    }  // one neighbour, however far along
    before = next;
    ++count;
  }
  return count;
}

/// Total least squares: the direction of the smaller eigenvalue of the neighbours' scatter.
ReferenceLine PlIcpMatcherCore::line_at(std::size_t position) const {
  const std::size_t below = neighbours(position, false);
  const std::size_t total = below + neighbours(position, true) + 1;
  if (total < 2) { return {}; }
  const Point2f origin = reference_at(position);  // differences keep float exact enough
  float x = 0.0F, y = 0.0F, xx = 0.0F, xy = 0.0F, yy = 0.0F;
  for (std::size_t k = 0; k < total; ++k) {
    const Point2f p = reference_at((position + reference_count_ - below + k) % reference_count_);
    const float dx = p.x_m - origin.x_m;
    const float dy = p.y_m - origin.y_m;
    x += dx;
    y += dy;
    xx += dx * dx;
    xy += dx * dy;
    yy += dy * dy;
  }
  const auto n = static_cast<float>(total);
  const float half = 0.5F * ((xx - x * x / n) - (yy - y * y / n));
  const float cross = xy - x * y / n;
  const float root = hypotenuse(half, cross);
  const float mean = 0.5F * ((xx - x * x / n) + (yy - y * y / n));
  if (!(mean - root <= config_.max_flatness * (mean + root))) { return {}; }
  // The normal is orthogonal to the longer row of (scatter - smaller eigenvalue).
  const bool first = half > 0.0F;
  const Point2f normal{first ? -cross : root - half, first ? half + root : -cross};
  const float length = hypotenuse(normal.x_m, normal.y_m);
  if (!(length > 0.0F)) { return {}; }
  return {{origin.x_m + x / n, origin.y_m + y / n}, {normal.x_m / length, normal.y_m / length}};
}

std::size_t PlIcpMatcherCore::find_pairs(std::size_t max_looks) {
  const SinCos<float> turn = sin_cos(report_.pose.theta_rad);
  if (next_ == 0) { pair_count_ = 0; }
  std::size_t looks = 0;
  for (; next_ < scan_count_ && looks < max_looks; ++next_) {
    const float x = request_.points.x_m[next_];
    const float y = request_.points.y_m[next_];
    const Point2f p{report_.pose.x_m + (turn.cosine * x - turn.sine * y),
                    report_.pose.y_m + (turn.sine * x + turn.cosine * y)};
    const Partner partner = nearest(p);
    looks += kLooksPerPoint + partner.looks;
    if (!partner.found) { continue; }
    const ReferenceLine& line = storage_.lines[partner.position];
    if (line.normal == Point2f{}) { continue; }
    storage_.pairs[pair_count_] = {static_cast<std::uint16_t>(next_), line.normal,
                                   line.normal.x_m * (p.x_m - line.anchor_m.x_m) +
                                       line.normal.y_m * (p.y_m - line.anchor_m.y_m)};
    ++pair_count_;
  }
  if (next_ == scan_count_) { stage_ = Stage::solution; }
  return looks;
}

float PlIcpMatcherCore::trim_limit() {
  const std::span<float> sorted = storage_.sorted_m.first(pair_count_);
  for (std::size_t k = 0; k < pair_count_; ++k) {
    sorted[k] = magnitude(storage_.pairs[k].distance_m);
  }
  const auto count = static_cast<std::int32_t>(pair_count_);
  const std::int32_t kept = floor_to_i32(config_.keep_share * static_cast<float>(count), 1, count);
  const auto last = sorted.begin() + (kept - 1);
  std::nth_element(sorted.begin(), last, sorted.end());
  return *last;
}

NormalEquations3 PlIcpMatcherCore::linearise(float limit_m, float& mean_squares, int& used) const {
  const SinCos<float> turn = sin_cos(report_.pose.theta_rad);
  NormalEquations3 system;
  float squares = 0.0F;
  used = 0;
  for (const LinePair& pair : storage_.pairs.first(pair_count_)) {
    if (magnitude(pair.distance_m) > limit_m) { continue; }
    const float x = request_.points.x_m[pair.point];
    const float y = request_.points.y_m[pair.point];
    const float j[3] = {pair.normal.x_m, pair.normal.y_m,
                        pair.normal.y_m * (turn.cosine * x - turn.sine * y) -
                            pair.normal.x_m * (turn.sine * x + turn.cosine * y)};
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column <= row; ++column) {
        system.h(row, column) += j[row] * j[column];
      }
      system.b[row] -= j[row] * pair.distance_m;
    }
    squares += square(pair.distance_m);
    ++used;
  }
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = row + 1; column < 3; ++column) {
      system.h(row, column) = system.h(column, row);
    }
  }
  mean_squares = used > 0 ? squares / static_cast<float>(used) : 0.0F;
  return system;
}

bool PlIcpMatcherCore::solve_step() {
  if (pair_count_ < static_cast<std::size_t>(config_.min_pairs)) {
    return finish(MatchOutcome::too_few_points);
  }
  float mean_squares = 0.0F;
  int used = 0;
  const NormalEquations3 system = linearise(trim_limit(), mean_squares, used);
  const float length = 2.0F;  // metres a radian is worth: about the mean range indoors
  const Conditioning conditioning = conditioning_of(system.h, length);
  report_.points = used;
  report_.inlier_share = static_cast<float>(used) / static_cast<float>(scan_count_);
  report_.mean_residual_m = square_root(mean_squares);
  // Residuals above the configured noise mean that lines fit worse than the sensor measures.
  const float weight = 1.0F / std::max(square(config_.sigma_m), mean_squares);
  for (std::size_t k = 0; k < 9; ++k) {
    report_.scan_information.elements[k] = weight * system.h.elements[k];
  }
  report_.length_m = length;
  report_.conditioning = conditioning;
  for (float& eigenvalue : report_.conditioning.eigenvalues) { eigenvalue *= weight; }
  report_.open_directions = open_directions(conditioning, config_.max_condition);
  const bool open = !(conditioning.condition <= config_.max_condition);
  StepSolution solution;
  if (is_prior(request_.prior)) {
    NormalEquations3 fused =
        open ? observable_part(system, conditioning, length, config_.max_condition) : system;
    for (float& element : fused.h.elements) { element *= weight; }
    for (float& element : fused.b) { element *= weight; }
    add_prior(request_.prior, report_.pose, fused);
    solution = solve(fused);
  } else {
    solution = open ? solve_constrained(system, conditioning, length, config_.max_condition)
                    : solve(system);
  }
  if (!solution.solved) { return finish(MatchOutcome::unsolvable); }
  ++report_.iterations;
  report_.pose = moved_by(report_.pose, solution.step);
  if (is_beyond(config_.max_total_m, config_.max_total_rad, request_.start, report_.pose)) {
    return finish(MatchOutcome::step_limit);
  }
  if (is_below(config_.converged_m, config_.converged_rad, solution.step)) {
    return finish(open ? MatchOutcome::degenerate : MatchOutcome::converged);
  }
  if (report_.iterations >= config_.max_iterations) {
    return finish(open ? MatchOutcome::degenerate : MatchOutcome::iteration_limit);
  }
  return false;
}

bool PlIcpMatcherCore::finish(MatchOutcome outcome) {
  report_.outcome = outcome;
  if (!keeps_pose(outcome)) { report_.pose = request_.start; }
  report_.covariance =
      covariance_of(sum(report_.scan_information, request_.prior.information), kUnknownVariance);
  done_ = true;
  return true;
}

MatchReport PlIcpMatcherCore::match(const PointsView& reference, const MatchRequest& request) {
  begin(reference, request);
  while (!step()) {}
  return report_;
}

}  // namespace picolo::inline v0
