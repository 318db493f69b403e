// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "cell_error.hpp"

#include <array>
#include <cstdint>
#include <numbers>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kBlock = 8;
constexpr float kGap_m = 1.0F;  // between neighbours on one wall, at most
constexpr std::int32_t kFar = 1 << 20;

/// A wave vector in cycles a cell and its first multiples. `gain`: the field's slope across walls
/// of that direction, where stairs blur it, times the share of the saw tooth that is left after
/// interpolation, both measured; over the squared length.
struct Waves {
  std::int8_t x = 0;
  std::int8_t y = 0;
  std::int8_t multiples = 1;
  float gain = 1.0F;
};
constexpr std::array<Waves, 20> kWaves{
    {{1, 0, 6, 1.0F},   {0, 1, 6, 1.0F},    {1, 1, 3, 0.11F},  {1, -1, 3, 0.11F},
     {2, 1, 1, 0.072F}, {2, -1, 1, 0.072F}, {1, 2, 1, 0.072F}, {1, -2, 1, 0.072F},
     {3, 1, 1, 0.05F},  {3, -1, 1, 0.05F},  {1, 3, 1, 0.05F},  {1, -3, 1, 0.05F},
     {3, 2, 1, 0.02F},  {3, -2, 1, 0.02F},  {2, 3, 1, 0.02F},  {2, -3, 1, 0.02F},
     {4, 1, 1, 0.034F}, {4, -1, 1, 0.034F}, {1, 4, 1, 0.034F}, {1, -4, 1, 0.034F}}};
constexpr std::size_t kSums = 34;

/// Gradients of one wave, its cosine and its sine, over all blocks.
struct Sum {
  std::array<float, 3> cosine{};
  std::array<float, 3> sine{};
};

/// Neighbours that stand for one place; window axes about the vehicle.
struct Block {
  std::size_t count = 0;
  Point2f sum{};
  Point2f first{};
  Point2f last{};
};

void add(const Block& block, float per_cell, std::array<Sum, kSums>& sums) {
  if (block.count < 2) { return; }
  const auto count = static_cast<float>(block.count);
  const float ends = per_cell * count / (count - 1.0F);
  const Point2f span{(block.last.x_m - block.first.x_m) * ends,
                     (block.last.y_m - block.first.y_m) * ends};
  const Point2f arm{block.sum.x_m / count, block.sum.y_m / count};
  std::size_t next = 0;
  for (const Waves& wave : kWaves) {
    const std::size_t index = next;
    next += static_cast<std::size_t>(wave.multiples);
    const auto x = static_cast<float>(wave.x);
    const auto y = static_cast<float>(wave.y);
    const float cycles = x * span.x_m + y * span.y_m;
    if (!(square(cycles) < 1.0F)) { continue; }  // they cancel within the block
    const float place = per_cell * (x * arm.x_m + y * arm.y_m);
    const float share = place - static_cast<float>(floor_to_i32(place, -kFar, kFar));
    const SinCos<float> phase = sin_cos(2.0F * std::numbers::pi_v<float> * share);
    const std::array<float, 3> gradient{x, y, y * arm.x_m - x * arm.y_m};
    SinCos<float> turned = phase;
    for (int m = 1; m <= wave.multiples; ++m) {
      const auto multiple = static_cast<float>(m);
      const float coherence = 1.0F - square(multiple * cycles);
      if (!(coherence > 0.0F)) { break; }
      const float weight = wave.gain * count * coherence / multiple;
      Sum& sum = sums[index + static_cast<std::size_t>(m) - 1];
      for (std::size_t i = 0; i < 3; ++i) {
        sum.cosine[i] += weight * turned.cosine * gradient[i];
        sum.sine[i] += weight * turned.sine * gradient[i];
      }
      turned = {turned.sine * phase.cosine + turned.cosine * phase.sine,
                turned.cosine * phase.cosine - turned.sine * phase.sine};
    }
  }
}

}  // namespace

Matrix3f cell_error(const PointsView& points, const Pose2f& window_T_base, float cell_m) {
  std::array<Sum, kSums> sums{};
  const SinCos<float> yaw = sin_cos(window_T_base.theta_rad);
  const float per_cell = 1.0F / cell_m;
  Block block;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Point2f arm{yaw.cosine * points.x_m[k] - yaw.sine * points.y_m[k],
                      yaw.sine * points.x_m[k] + yaw.cosine * points.y_m[k]};
    const float gap = square(arm.x_m - block.last.x_m) + square(arm.y_m - block.last.y_m);
    if (block.count == kBlock || gap > square(kGap_m)) {
      add(block, per_cell, sums);
      block.count = 0;
    }
    if (block.count == 0) { block = {.first = arm}; }
    ++block.count;
    block.sum = {block.sum.x_m + arm.x_m, block.sum.y_m + arm.y_m};
    block.last = arm;
  }
  add(block, per_cell, sums);

  constexpr float kSquareOfWave =
      2.0F * std::numbers::pi_v<float> * std::numbers::pi_v<float>;  // of a saw tooth's
  const float variance_m2 = square(cell_m) / kSquareOfWave;
  Matrix3f covariance{};
  for (const Sum& sum : sums) {
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        covariance(row, column) +=
            variance_m2 * (sum.cosine[row] * sum.cosine[column] + sum.sine[row] * sum.sine[column]);
      }
    }
  }
  return covariance;
}

}  // namespace picolo::inline v0
