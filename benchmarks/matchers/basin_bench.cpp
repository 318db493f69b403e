// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Where each matcher ends from a disturbed start: the share that finds the pose, its iterations and
// its time. This is where Levenberg-Marquardt, NDT and ICP differ from Gauss-Newton.

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "picolo/core/random.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/map/ndt_map.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/matching/icp.hpp"
#include "picolo/matching/levenberg_marquardt.hpp"
#include "picolo/matching/ndt.hpp"
#include "support/walls.hpp"

namespace picolo::bench {
namespace {

constexpr int kStarts = 200;

struct Room {
  std::unique_ptr<RollingMap<640, 640>> map = std::make_unique<RollingMap<640, 640>>();
  std::unique_ptr<NdtMap<64, 64>> ndt = std::make_unique<NdtMap<64, 64>>();
  Pose2d truth{0.3, -0.2, 0.4};
  test::Scan scan;
  test::Scan reference = test::scan_at(test::furnished_room(), {0.25, -0.15, 0.35}, 360);

  Room() {
    Random random{9};
    scan = test::scan_at(test::furnished_room(), truth, 360);
    for (std::size_t k = 0; k < scan.x_m.size(); ++k) {  // 2 cm of noise, a tenth outliers
      const float range = std::hypot(scan.x_m[k], scan.y_m[k]);
      float noisy = range + static_cast<float>(0.02 * random.gaussian());
      if (random.below(10) == 0) { noisy *= random.uniform_f32(); }
      scan.x_m[k] *= noisy / range;
      scan.y_m[k] *= noisy / range;
    }
    for (const Pose2d pose : {Pose2d{0, 0, 0}, Pose2d{1, 1, 1}, Pose2d{-1, -0.5, 2}}) {
      const test::Scan seen = test::scan_at(test::furnished_room(), pose, 1440);
      map->core().begin_scan();
      for (std::size_t k = 0; k < seen.x_m.size(); ++k) {
        const Point2f p{seen.x_m[k], seen.y_m[k]};
        map->core().add_hit(transform(to_window(map->core().window(), pose), p));
        ndt->core().add(transform(to_window(ndt->core().window(), pose), p));
      }
    }
  }
};

/// `match`: start in the map -> report and pose in the map.
template <typename Match>
void basin(benchmark::State& state, const Room& room, const Match& match) {
  const double offset_m = 1e-2 * static_cast<double>(state.range(0));
  const double offset_rad = 0.01745329 * static_cast<double>(state.range(1));
  int found = 0;
  int iterations = 0;
  int runs = 0;
  for (auto _ : state) {
    Random random{3};
    for (int i = 0; i < kStarts; ++i) {
      const double direction = random.uniform(-3.14159, 3.14159);
      const double turn = random.uniform(-offset_rad, offset_rad);
      const Pose2d start =
          room.truth * Pose2d{offset_m * std::cos(direction), offset_m * std::sin(direction), turn};
      Pose2d pose = start;
      iterations += match(start, pose);
      const Pose2d error = between(room.truth, pose);
      found +=
          std::hypot(error.x_m, error.y_m) < 0.05 && std::abs(error.theta_rad) < 0.0175 ? 1 : 0;
      ++runs;
    }
  }
  state.counters["found_percent"] = 100.0 * found / runs;
  state.counters["iterations"] = static_cast<double>(iterations) / runs;
  state.counters["per_match"] =
      benchmark::Counter(runs, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

constexpr GaussNewtonConfig kWide{.max_iterations = 50, .max_total_m = 3.0F, .max_total_rad = 2.0F};

void gauss_newton(benchmark::State& state) {
  const Room room;
  GaussNewtonMatcher<DistanceFieldView> matcher{kWide};
  const GridWindow& window = room.map->core().window();
  basin(state, room, [&](const Pose2d& start, Pose2d& pose) {
    const MatchReport report =
        matcher.match(room.map->core().field(), {room.scan.view(), to_window(window, start), {}});
    pose = to_map(window, report.pose);
    return report.iterations;
  });
}

void levenberg_marquardt(benchmark::State& state) {
  const Room room;
  LevenbergMarquardtMatcher<DistanceFieldView> matcher{{.residual = kWide}};
  const GridWindow& window = room.map->core().window();
  basin(state, room, [&](const Pose2d& start, Pose2d& pose) {
    const MatchReport report =
        matcher.match(room.map->core().field(), {room.scan.view(), to_window(window, start), {}});
    pose = to_map(window, report.pose);
    return report.iterations;
  });
}

void ndt(benchmark::State& state) {
  const Room room;
  NdtMatcher matcher{{.max_iterations = 50, .max_total_m = 3.0F, .max_total_rad = 2.0F}};
  const GridWindow& window = room.ndt->core().window();
  basin(state, room, [&](const Pose2d& start, Pose2d& pose) {
    const MatchReport report =
        matcher.match(room.ndt->core().view(), {room.scan.view(), to_window(window, start), {}});
    pose = to_map(window, report.pose);
    return report.iterations;
  });
}

void icp(benchmark::State& state) {
  const Room room;
  auto matcher = std::make_unique<IcpMatcher<400>>(IcpConfig{
      .max_pair_m = 1.0F, .keep_share = 0.8F, .max_total_m = 3.0F, .max_total_rad = 2.0F});
  const Pose2d map_T_reference{0.25, -0.15, 0.35};
  basin(state, room, [&](const Pose2d& start, Pose2d& pose) {
    const MatchReport report = matcher->match(
        room.reference.view(), {room.scan.view(), to_f32(between(map_T_reference, start)), {}});
    pose = map_T_reference * to_f64(report.pose);
    return report.iterations;
  });
}

void starts(benchmark::internal::Benchmark* bench) {
  bench->ArgNames({"cm", "deg"})->Args({10, 3})->Args({30, 10})->Args({60, 20})->Args({90, 35});
  bench->Unit(benchmark::kMillisecond)->Iterations(2);
}
BENCHMARK(gauss_newton)->Name("basin/gauss_newton")->Apply(starts);
BENCHMARK(levenberg_marquardt)->Name("basin/levenberg_marquardt")->Apply(starts);
BENCHMARK(ndt)->Name("basin/ndt")->Apply(starts);
BENCHMARK(icp)->Name("basin/icp")->Apply(starts);

}  // namespace
}  // namespace picolo::bench
