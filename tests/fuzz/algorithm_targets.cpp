// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Any sweep into the matcher, any drive into the calibration; their own counters against the
// bounds they declare.
#include <algorithm>
#include <array>
#include <bit>

#include "picolo/calibration/wheel_streaming.hpp"
#include "picolo/core/math.hpp"
#include "picolo/matching/gauss_newton.hpp"
#include "targets.hpp"

namespace picolo::fuzz {
namespace {

constexpr int kCells = 64;

/// A room with walls along its border, drawn once.
const std::array<std::uint8_t, std::size_t{kCells} * kCells>& room() {
  static const auto kRoom = [] {
    std::array<std::uint8_t, std::size_t{kCells} * kCells> cells{};
    for (int row = 0; row < kCells; ++row) {
      for (int column = 0; column < kCells; ++column) {
        const int wall = std::min(std::min(row - 4, column - 4),
                                  std::min(kCells - 5 - row, kCells - 5 - column));
        const int distance = std::min(255, 28 * (wall < 0 ? -wall : wall));
        cells[static_cast<std::size_t>(row * kCells + column)] =
            static_cast<std::uint8_t>(distance);
      }
    }
    return cells;
  }();
  return kRoom;
}

/// Floats of any bits now and then, else points about the room.
float coordinate(Reader& reader) {
  const std::uint8_t kind = reader.byte();
  if (kind < 4) { return std::bit_cast<float>(reader.word(4)); }
  return reader.between(-4.0F, 4.0F);
}

void sweeps(Input input) {
  constexpr std::size_t kMaxPoints = 80;
  Reader reader{input};
  const GaussNewtonConfig config{.min_points = 8};
  const DistanceFieldView field{.cells = room().data(), .width = kCells, .height = kCells};
  MatchRequest request;
  request.start = {coordinate(reader), coordinate(reader), reader.between(-4.0F, 4.0F)};
  std::array<float, kMaxPoints> x{};
  std::array<float, kMaxPoints> y{};
  std::size_t count = 0;
  for (; count < kMaxPoints && !reader.empty(); ++count) {
    x[count] = coordinate(reader);
    y[count] = coordinate(reader);
  }
  request.points = {std::span<const float>{x}.first(count), std::span<const float>{y}.first(count)};
  GaussNewtonMatcher<DistanceFieldView> matcher{config};
  matcher.begin(field, request);
  int steps = 0;
  while (!matcher.step()) {
    ++steps;
    require(steps <= config.max_iterations + 1, "the matcher iterates beyond its bound");
  }
  const MatchReport& report = matcher.report();
  require(report.iterations <= config.max_iterations, "more iterations reported than allowed");
  require(report.points >= 0 && report.points <= static_cast<int>(count), "points out of nothing");
  if (report.outcome != MatchOutcome::converged) { return; }
  require(
      is_finite(report.pose.x_m) && is_finite(report.pose.y_m) && is_finite(report.pose.theta_rad),
      "converged to a pose that is no number");
  require(hypotenuse(report.pose.x_m - request.start.x_m, report.pose.y_m - request.start.y_m) <=
              config.max_total_m + 0.01F,
          "converged beyond the longest way allowed");
}

double rate(Reader& reader) {
  const std::uint8_t kind = reader.byte();
  if (kind < 3) {
    return std::bit_cast<double>((std::uint64_t{reader.word(4)} << 32U) | reader.word(4));
  }
  return static_cast<double>(reader.between(-20.0F, 20.0F));
}

void drives(Input input) {
  Reader reader{input};
  WheelStreaming calibration;
  double stamp_s = 0.0;
  while (!reader.empty()) {
    const std::uint8_t kind = reader.byte();
    WheelStretch stretch{.duration_s = 0.001 * (kind & 0x3FU),
                         .left_radps = rate(reader),
                         .right_radps = rate(reader),
                         .closes = (kind & 0x40U) != 0};
    stamp_s += stretch.duration_s;
    ScanMotion scan{.stamp_s = stamp_s};
    if (stretch.closes) {
      scan.motion = {rate(reader) / 20.0, rate(reader) / 20.0, rate(reader) / 20.0};
    }
    calibration.add(stretch, scan);
  }
  WheelReport report;
  const Status status = calibration.solve(report);
  require(static_cast<int>(status) >= 0, "a status that is none");
}

}  // namespace

std::vector<Target> algorithm_targets() {
  return {{"sweeps", sweeps, true}, {"drives", drives, true}};
}

}  // namespace picolo::fuzz
