// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The matcher per point and iteration beside the floor kernel, both timed in turns in the same run;
// then a whole match, and a match with its map update.

#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "floor_kernel.hpp"
#include "picolo/matching/field_sums.hpp"
#include "picolo/matching/surface.hpp"
#include "scene.hpp"

namespace picolo::bench {
namespace {

double median(std::vector<double>& values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

/// Of this thread's processor time: what others do on the machine shall not count.
double thread_time_ns() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

template <typename Body>
double nanoseconds(const Body& body) {
  const double start = thread_time_ns();
  body();
  return thread_time_ns() - start;
}

/// `state.range(0)`: with the directions of the points' surfaces, as the localiser asks.
void sums_per_point(benchmark::State& state) {
  const Scene scene;
  std::vector<std::int8_t> along_x(scene.scan.x_m.size());
  std::vector<std::int8_t> along_y(scene.scan.x_m.size());
  PointsView view = scene.scan.view();
  surface_directions(view, SurfaceConfig{}, along_x, along_y);
  if (state.range(0) != 0) {
    view.along_x = along_x;
    view.along_y = along_y;
  }
  const DistanceFieldView field = scene.map().field();
  const Pose2f pose = to_window(scene.map().window(), {0.08, 0.06, 0.03});
  const FieldWalk walk{pose.x_m, pose.y_m, std::sin(pose.theta_rad), std::cos(pose.theta_rad),
                       11.0F,    0.2F};
  const auto points = static_cast<double>(scene.scan.x_m.size());
  constexpr int kRepeats =
      20;  // long enough for the clock, short enough to share its luck with the other
  std::vector<double> ours;
  std::vector<double> floor;
  for (auto _ : state) {
    ours.push_back(nanoseconds([&] {
      for (int i = 0; i < kRepeats; ++i) {
        benchmark::DoNotOptimize(walk_field(field, walk, view));
      }
    }));
    floor.push_back(nanoseconds([&] {
      for (int i = 0; i < kRepeats; ++i) {
        benchmark::DoNotOptimize(
            floor_sums(field.cells, field.width, field.cells_per_m, pose, scene.scan.view()));
      }
    }));
  }
  const double ours_ns = median(ours) / (kRepeats * points);
  const double floor_ns = median(floor) / (kRepeats * points);
  state.counters["ns_per_point"] = ours_ns;
  state.counters["floor_ns_per_point"] = floor_ns;
  state.counters["ratio_to_floor"] = ours_ns / floor_ns;
}
BENCHMARK(sums_per_point)
    ->Name("match/sums_per_point_and_iteration/surfaces")
    ->Arg(0)
    ->Arg(1)
    ->Iterations(2000);

/// Start 10 cm and 2 degrees off: what odometry leaves to correct.
MatchRequest request_in(const Scene& scene) {
  return {scene.scan.view(), to_window(scene.map().window(), {0.17, -0.02, 0.055}), {}};
}

double floor_of(const Scene& scene) {
  const DistanceFieldView field = scene.map().field();
  const Pose2f pose = to_window(scene.map().window(), {0.08, 0.06, 0.03});
  return nanoseconds([&] {
    benchmark::DoNotOptimize(
        floor_sums(field.cells, field.width, field.cells_per_m, pose, scene.scan.view()));
  });
}

/// `ratio_to_floor`: to as many walks of the floor kernel as the match has iterations.
void report(benchmark::State& state, std::vector<double>& times, std::vector<double>& floor,
            int iterations) {
  const double middle = median(times);
  std::sort(times.begin(), times.end());
  state.counters["iterations"] = iterations;
  state.counters["median_us"] = middle * 1e-3;
  state.counters["p99_over_median"] = times[times.size() * 99 / 100] / middle;
  state.counters["ratio_to_floor"] = middle / (iterations * median(floor));
}

void whole_match(benchmark::State& state) {
  const Scene scene;
  GaussNewtonMatcher<DistanceFieldView> matcher;
  const MatchRequest request = request_in(scene);
  int iterations = 0;
  std::vector<double> times;
  std::vector<double> floor;
  for (auto _ : state) {
    times.push_back(
        nanoseconds([&] { iterations = matcher.match(scene.map().field(), request).iterations; }));
    floor.push_back(floor_of(scene));
  }
  report(state, times, floor, iterations);
}
BENCHMARK(whole_match)->Name("match/360_beams")->Iterations(3000);

void match_and_map(benchmark::State& state) {
  Scene scene;
  LocaliserCore& core = scene.localiser->core();
  std::vector<double> times;
  std::vector<double> floor;
  int iterations = 0;
  double step = 0.0;
  for (auto _ : state) {
    step = 0.01 - step;  // back and forth by a centimetre
    const test::Scan scan = test::scan_at(test::furnished_room(), {0.1 + step, 0.05, 0.02}, 360);
    times.push_back(nanoseconds([&] {
      static_cast<void>(core.process(Scene::sweep_of(scan, {0.1 + step, 0.05, 0.02}), true));
    }));
    iterations = core.report().iterations;
    floor.push_back(floor_of(scene));
  }
  report(state, times, floor, iterations);
}
BENCHMARK(match_and_map)->Name("localiser/360_beams_match_and_map")->Iterations(1000);

}  // namespace
}  // namespace picolo::bench
