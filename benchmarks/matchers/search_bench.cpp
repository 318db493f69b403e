// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The searches over +-0.5 m and +-30 degrees with a scan of 360 beams, and relocalisation in a
// whole map.

#include <benchmark/benchmark.h>

#include <memory>

#include "picolo/map/max_pyramid.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/matching/correlative.hpp"
#include "picolo/matching/pose_search.hpp"
#include "support/walls.hpp"

namespace picolo::bench {
namespace {

struct Scene {
  using Map = RollingMap<640, 640>;
  std::unique_ptr<Map> map = std::make_unique<Map>();
  std::unique_ptr<MaxPyramid<640, 640, 3>> pyramid = std::make_unique<MaxPyramid<640, 640, 3>>();
  test::Scan scan = test::scan_at(test::furnished_room(), {0.3, -0.2, 0.4}, 360);
  Pose2f near{};

  Scene() {
    for (const Pose2d pose : {Pose2d{0, 0, 0}, Pose2d{1, 1, 1}, Pose2d{-1, -0.5, 2}}) {
      const test::Scan seen = test::scan_at(test::furnished_room(), pose, 1440);
      map->core().begin_scan();
      for (std::size_t k = 0; k < seen.x_m.size(); ++k) {
        map->core().add_hit(
            transform(to_window(map->core().window(), pose), {seen.x_m[k], seen.y_m[k]}));
      }
    }
    pyramid->core().begin(map->core().field());
    static_cast<void>(pyramid->core().step(1 << 20));
    near = to_window(map->core().window(), {0.1, 0.1, 0.6});
  }
};

void correlative(benchmark::State& state) {
  const Scene scene;
  CorrelativeSearch search{{.max_points = static_cast<int>(state.range(0))}};
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        search.search(scene.map->core().field(), scene.scan.view(), {.centre = scene.near}));
  }
  state.counters["score"] = static_cast<double>(search.candidates()[0].score);
}
BENCHMARK(correlative)
    ->Name("search/grid_10cm_2deg_50cm_30deg/points")
    ->Arg(96)
    ->Arg(128)
    ->Unit(benchmark::kMillisecond);

void branch_and_bound(benchmark::State& state) {
  const Scene scene;
  PoseSearch search{{.rotation_step_rad = 0.0087266F,
                     .order = state.range(0) == 0 ? ChildOrder::index : ChildOrder::best_first}};
  for (auto _ : state) {
    benchmark::DoNotOptimize(search.search(scene.map->core().field(), scene.pyramid->view(),
                                           scene.scan.view(), {.centre = scene.near}));
  }
  state.counters["nodes"] = search.report().nodes;
  state.counters["poses"] = 21.0 * 21.0 * 121.0;
}
BENCHMARK(branch_and_bound)
    ->Name("search/exact_5cm_half_deg_50cm_30deg/best_first")
    ->Arg(0)
    ->Arg(1)
    ->Unit(benchmark::kMillisecond);

void relocalise(benchmark::State& state) {
  const Scene scene;
  PoseSearch search{{.min_score = 0.5F}};
  const SearchWindow everywhere{
      .centre = {16.0F, 16.0F, 0.0F}, .half_translation_m = 16.0F, .half_rotation_rad = 3.1415926F};
  for (auto _ : state) {
    benchmark::DoNotOptimize(search.search(scene.map->core().field(), scene.pyramid->view(),
                                           scene.scan.view(), everywhere));
  }
  state.counters["nodes"] = search.report().nodes;
  state.counters["score"] = static_cast<double>(search.report().best.score);
}
BENCHMARK(relocalise)->Name("search/relocalise_32m_360deg")->Unit(benchmark::kMillisecond);

void pyramid(benchmark::State& state) {
  const Scene scene;
  for (auto _ : state) {
    scene.pyramid->core().begin(scene.map->core().field());
    benchmark::DoNotOptimize(scene.pyramid->core().step(1 << 20));
  }
}
BENCHMARK(pyramid)->Name("search/pyramid_640x640")->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace picolo::bench
