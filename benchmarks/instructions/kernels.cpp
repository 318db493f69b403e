// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// kernels NAME TIMES: runs one piece of work so many times, and nothing else that depends on TIMES.
// count.sh runs it under callgrind with two numbers of times; the difference is what the work
// costs.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "picolo/matching/correlative.hpp"
#include "picolo/matching/field_sums.hpp"
#include "pipeline/floor_kernel.hpp"
#include "pipeline/scene.hpp"

namespace {

using namespace picolo;
using bench::Scene;

float sink = 0.0F;

void sums(const Scene& scene, int times) {
  const Pose2f pose = to_window(scene.map().window(), {0.08, 0.06, 0.03});
  const FieldWalk walk{pose.x_m, pose.y_m, std::sin(pose.theta_rad), std::cos(pose.theta_rad),
                       11.0F,    0.2F};
  for (int i = 0; i < times; ++i) {
    sink += walk_field(scene.map().field(), walk, scene.scan.view()).tt;
  }
}

void floor_kernel(const Scene& scene, int times) {
  const DistanceFieldView field = scene.map().field();
  const Pose2f pose = to_window(scene.map().window(), {0.08, 0.06, 0.03});
  for (int i = 0; i < times; ++i) {
    sink +=
        bench::floor_sums(field.cells, field.width, field.cells_per_m, pose, scene.scan.view()).tt;
  }
}

void match(const Scene& scene, int times) {
  GaussNewtonMatcher<DistanceFieldView> matcher;
  const MatchRequest request{
      scene.scan.view(), to_window(scene.map().window(), {0.17, -0.02, 0.055}), {}};
  for (int i = 0; i < times; ++i) { sink += matcher.match(scene.map().field(), request).cost; }
}

void search(const Scene& scene, int times) {
  CorrelativeSearch search{CorrelativeConfig{}};
  const SearchWindow window{.centre = to_window(scene.map().window(), {0.17, -0.02, 0.055})};
  for (int i = 0; i < times; ++i) {
    static_cast<void>(search.search(scene.map().field(), scene.scan.view(), window));
    sink += search.candidates()[0].score;
  }
}

void scan(Scene& scene, int times) {
  LocaliserCore& core = scene.localiser->core();
  for (int i = 0; i < times; ++i) {
    static_cast<void>(core.process(Scene::sweep_of(scene.scan, {0.1, 0.05, 0.02}), true));
    sink += core.report().cost;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) { return 2; }
  Scene scene;
  const char* const name = argv[1];
  const int times = std::atoi(argv[2]);
  if (std::strcmp(name, "sums") == 0) { sums(scene, times); }
  if (std::strcmp(name, "floor") == 0) { floor_kernel(scene, times); }
  if (std::strcmp(name, "match") == 0) { match(scene, times); }
  if (std::strcmp(name, "search") == 0) { search(scene, times); }
  if (std::strcmp(name, "scan") == 0) { scan(scene, times); }
  std::printf("%zu points, %g\n", scene.scan.x_m.size(), static_cast<double>(sink));
  return 0;
}
