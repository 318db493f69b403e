// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "cell_error.hpp"

#include <array>
#include <cstdint>
#include <numbers>
#include <span>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kStride = 3;  // a third of the points tell as much
constexpr std::size_t kBlock = 3;   // of these
constexpr float kGap_m = 1.0F;      // between neighbours on one wall, at most
constexpr std::int32_t kFar = 1 << 20;

/// A wave vector in cycles a cell and its first multiples. `gain`: the field's slope across walls
/// of that direction, where stairs blur it, times the share of the saw tooth that is left after
/// interpolation, both measured; over the squared length. `turned`: the same wall, should the sweep
/// have followed a stair of it.
struct Waves {
  std::int8_t x = 0;
  std::int8_t y = 0;
  std::int8_t multiples = 1;
  std::int8_t turned = 0;
  float gain = 1.0F;
};
constexpr std::array<Waves, 2> kAlongCells{{{1, 0, 6, 0, 1.0F}, {0, 1, 6, 0, 1.0F}}};
/// And, with -y, those of walls that fall.
constexpr std::array<Waves, 9> kRising{{{1, 1, 3, 0, 0.11F},
                                        {2, 1, 1, 0, 0.072F},
                                        {1, 2, 1, 0, 0.072F},
                                        {3, 1, 1, 0, 0.05F},
                                        {1, 3, 1, 0, 0.05F},
                                        {3, 2, 1, 0, 0.02F},
                                        {2, 3, 1, 0, 0.02F},
                                        {4, 1, 1, 0, 0.034F},
                                        {1, 4, 1, 0, 0.034F}}};
constexpr std::array<Waves, 4> kTurned{
    {{1, 0, 3, 1, 0.55F}, {1, 0, 3, -1, 0.55F}, {0, 1, 3, 1, 0.55F}, {0, 1, 3, -1, 0.55F}}};

constexpr std::size_t multiples_of(std::span<const Waves> waves) {
  std::size_t count = 0;
  for (const Waves& wave : waves) { count += static_cast<std::size_t>(wave.multiples); }
  return count;
}
constexpr float kAsTheyAre = 1.0F;
constexpr float kFalling = -1.0F;
struct Set {
  std::span<const Waves> waves;
  float side = kAsTheyAre;
};
/// In the order of their sums.
constexpr std::array<Set, 4> kSets{
    {{kAlongCells, kAsTheyAre}, {kRising, kAsTheyAre}, {kRising, kFalling}, {kTurned, kAsTheyAre}}};

constexpr std::size_t kFirstRising = multiples_of(kAlongCells);
constexpr std::size_t kFirstFalling = kFirstRising + multiples_of(kRising);
constexpr std::size_t kFirstTurned = kFirstFalling + multiples_of(kRising);
constexpr std::size_t kSums = kFirstTurned + multiples_of(kTurned);
constexpr float kStair = 0.25F;           // see Stairs
constexpr float kHardlyParallel = 0.05F;  // gradients of so small a share add nothing

/// Of one wave, its cosine and its sine over all blocks: its weight, and its torque about the
/// vehicle. All its gradients in x and y are the wave vector.
struct Sum {
  SinCos<float> weight{};
  SinCos<float> torque{};
};

/// Where all walls run the same way, a sweep can turn until a stair of cells looks like a wall to
/// it, and its own phases are then the stair's.
struct Stairs {
  float parallel = 0.0F;  ///< 0: the scan constrains all ways the same, 1: one way alone
  float slope = 0.0F;     ///< of a sweep that follows one step over all it sees: tan of the turn
};

Stairs stairs_of(const MatchReport& report, float cell_m) {
  const Matrix3f& h = report.scan_information;
  const float apart = square(h(0, 0) - h(1, 1)) + 4.0F * square(h(0, 1));
  const float all = square(h(0, 0) + h(1, 1));
  return {all > 0.0F ? square(apart / all) : 0.0F, kStair * cell_m / report.length_m};
}

/// Neighbours that stand for one place; window axes about the vehicle.
struct Block {
  std::size_t count = 0;
  Point2f sum{};
  Point2f first{};
  Point2f last{};
};

/// A block as the waves see it, lengths in cells.
struct Stretch {
  float count = 0.0F;
  Point2f span{};
  Point2f arm_m{};
  float per_cell = 1.0F;
};

// Four copies of it would be as fast and fill a kilobyte of flash.
[[gnu::noinline]] void add_waves(std::span<const Waves> waves, float side, const Stretch& stretch,
                                 const Stairs& stairs, Sum* sums) {
  const Point2f& arm = stretch.arm_m;
  for (const Waves& wave : waves) {
    Sum* const first = sums;
    sums += wave.multiples;
    const auto x = static_cast<float>(wave.x);
    const float y = side * static_cast<float>(wave.y);
    const float cycles = x * stretch.span.x_m + y * stretch.span.y_m;
    if (!(square(cycles) < 1.0F)) { continue; }  // they cancel within the block
    const float turn = stairs.slope * static_cast<float>(wave.turned);
    const float place =
        stretch.per_cell * (x * (arm.x_m + turn * arm.y_m) + y * (arm.y_m - turn * arm.x_m));
    const float gain = wave.turned != 0 ? stairs.parallel * wave.gain : wave.gain;
    const float share = place - static_cast<float>(floor_to_i32(place, -kFar, kFar));
    const SinCos<float> phase = sin_cos(2.0F * std::numbers::pi_v<float> * share);
    const float torque = y * arm.x_m - x * arm.y_m;
    SinCos<float> turned = phase;
    for (int m = 1; m <= wave.multiples; ++m) {
      const auto multiple = static_cast<float>(m);
      const float coherence = 1.0F - square(multiple * cycles);
      if (!(coherence > 0.0F)) { break; }
      const float weight = gain * stretch.count * coherence / multiple;
      const SinCos<float> part{weight * turned.sine, weight * turned.cosine};
      Sum& sum = first[m - 1];
      sum.weight = {sum.weight.sine + part.sine, sum.weight.cosine + part.cosine};
      sum.torque = {sum.torque.sine + torque * part.sine, sum.torque.cosine + torque * part.cosine};
      turned = {turned.sine * phase.cosine + turned.cosine * phase.sine,
                turned.cosine * phase.cosine - turned.sine * phase.sine};
    }
  }
}

void add(const Block& block, float per_cell, const Stairs& stairs, std::array<Sum, kSums>& sums) {
  if (block.count < 2) { return; }
  const auto count = static_cast<float>(block.count);
  const float ends = per_cell * count / (count - 1.0F);
  const Stretch stretch{
      count,
      {(block.last.x_m - block.first.x_m) * ends, (block.last.y_m - block.first.y_m) * ends},
      {block.sum.x_m / count, block.sum.y_m / count},
      per_cell};
  add_waves(kAlongCells, kAsTheyAre, stretch, stairs, sums.data());
  // No wave that rises can cancel less than the shortest along a wall that rises.
  const float product = stretch.span.x_m * stretch.span.y_m;
  const bool cancels = magnitude(stretch.span.x_m) + magnitude(stretch.span.y_m) >= 1.0F;
  if (!cancels || product <= 0.0F) {
    add_waves(kRising, kAsTheyAre, stretch, stairs, sums.data() + kFirstRising);
  }
  if (!cancels || product >= 0.0F) {
    add_waves(kRising, kFalling, stretch, stairs, sums.data() + kFirstFalling);
  }
  if (stairs.parallel > kHardlyParallel) {
    add_waves(kTurned, kAsTheyAre, stretch, stairs, sums.data() + kFirstTurned);
  }
}

}  // namespace

Matrix3f cell_error(const PointsView& points, const MatchReport& report, float cell_m) {
  std::array<Sum, kSums> sums{};
  const SinCos<float> yaw = sin_cos(report.pose.theta_rad);
  const Stairs stairs = stairs_of(report, cell_m);
  const float per_cell = 1.0F / cell_m;
  Block block;
  for (std::size_t k = 0; k < points.size(); k += kStride) {
    const Point2f arm{yaw.cosine * points.x_m[k] - yaw.sine * points.y_m[k],
                      yaw.sine * points.x_m[k] + yaw.cosine * points.y_m[k]};
    const float gap = square(arm.x_m - block.last.x_m) + square(arm.y_m - block.last.y_m);
    if (block.count == kBlock || gap > square(kGap_m)) {
      add(block, per_cell, stairs, sums);
      block.count = 0;
    }
    if (block.count == 0) { block = {.first = arm}; }
    ++block.count;
    block.sum = {block.sum.x_m + arm.x_m, block.sum.y_m + arm.y_m};
    block.last = arm;
  }
  add(block, per_cell, stairs, sums);

  Matrix3f covariance{};
  const Sum* sum = sums.data();
  for (const Set& set : kSets) {
    for (const Waves& wave : set.waves) {
      const auto x = static_cast<float>(wave.x);
      const float y = set.side * static_cast<float>(wave.y);
      for (int m = 1; m <= wave.multiples; ++m, ++sum) {
        const SinCos<float>& w = sum->weight;
        const SinCos<float>& t = sum->torque;
        const float ww = w.cosine * w.cosine + w.sine * w.sine;
        const float wt = w.cosine * t.cosine + w.sine * t.sine;
        covariance(0, 0) += x * x * ww;
        covariance(1, 0) += x * y * ww;
        covariance(1, 1) += y * y * ww;
        covariance(2, 0) += x * wt;
        covariance(2, 1) += y * wt;
        covariance(2, 2) += t.cosine * t.cosine + t.sine * t.sine;
      }
    }
  }
  covariance(0, 1) = covariance(1, 0);
  covariance(0, 2) = covariance(2, 0);
  covariance(1, 2) = covariance(2, 1);

  constexpr float kSquareOfWave =
      2.0F * std::numbers::pi_v<float> * std::numbers::pi_v<float>;  // of a saw tooth's
  const float variance_m2 = square(cell_m * static_cast<float>(kStride)) / kSquareOfWave;
  return scaled(covariance, variance_m2);
}

}  // namespace picolo::inline v0
