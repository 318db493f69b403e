// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The map update by rays, the repair of one tile, and the undistortion of a sweep.

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>
#include <vector>

#include "scene.hpp"

namespace picolo::bench {
namespace {

void map_update(benchmark::State& state) {
  Scene scene;
  auto map = std::make_unique<RollingMap<640, 640>>();
  RollingMapCore& core = map->core();
  const Pose2f centre = to_window(core.window(), {});
  std::vector<Point2f> ends;
  for (std::size_t k = 0; k < scene.scan.x_m.size(); ++k) {
    ends.push_back({centre.x_m + scene.scan.x_m[k], centre.y_m + scene.scan.y_m[k]});
  }
  for (auto _ : state) {
    core.begin_scan();
    for (const Point2f& end : ends) { core.add_hit(end); }
    for (const Point2f& end : ends) { core.add_ray({centre.x_m, centre.y_m}, end, 2); }
    while (core.stale_tiles() > 0) { core.repair(8); }
  }
  state.counters["per_ray"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(ends.size()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(map_update)->Name("map/update_360_beams");

void repair_tile(benchmark::State& state) {
  auto map = std::make_unique<RollingMap<64, 64>>();
  RollingMapCore& core = map->core();
  const Pose2f centre = to_window(core.window(), {0.02, 0.02, 0.0});
  const auto free_it = [&] {
    core.begin_scan();
    core.add_hit({centre.x_m, centre.y_m});
    for (int i = 0; i < 4; ++i) {
      core.begin_scan();
      core.add_ray({centre.x_m - 0.5F, centre.y_m}, {centre.x_m + 0.5F, centre.y_m}, 0);
    }
  };
  double tiles = 0;
  for (auto _ : state) {
    state.PauseTiming();
    free_it();
    state.ResumeTiming();
    tiles += core.repair(100);
  }
  state.counters["per_tile"] =
      benchmark::Counter(tiles, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(repair_tile)->Name("map/repair")->Iterations(20000);

void undistort(benchmark::State& state) {
  constexpr std::size_t kBeams = 450;
  PoseBuffer<64> poses;
  for (int i = 0; i < 40; ++i) {
    static_cast<void>(poses.push({Timestamp{Duration{5000 * i}}, {0.005 * i, 0.0, 0.008 * i}}));
  }
  std::vector<RangeReturn> returns;
  for (std::size_t k = 0; k < kBeams; ++k) {
    const float share = static_cast<float>(k) / kBeams;
    returns.push_back({3.0F, -3.1F + 6.2F * share, 0.1F * share});
  }
  const Sweep sweep{
      .stamp = Timestamp{20ms},
      .last_stamp =
          Timestamp{20ms} + from_seconds(static_cast<double>(returns.back().since_sweep_start_s)),
      .sequence = 0,
      .returns = returns};
  Undistorter<kBeams> undistorter;
  for (auto _ : state) {
    static_cast<void>(undistorter.begin({}, sweep));
    benchmark::DoNotOptimize(undistorter.step(poses.core(), kBeams));
  }
  state.counters["per_return"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * kBeams,
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(undistort)->Name("undistort/450_returns");

}  // namespace
}  // namespace picolo::bench
