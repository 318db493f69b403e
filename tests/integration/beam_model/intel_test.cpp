// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The beam model learnt from a real laser: ranges of the Intel lab against a map built from the
// same log's corrected poses.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "picolo/map/ray_cast.hpp"
#include "picolo/sensing/beam_model.hpp"
#include "support/data.hpp"
#include "support/gz_lines.hpp"

namespace picolo {
namespace {

constexpr const char* kLog = "raw2d/intel_corrected_rt.clf.gz";
constexpr float kMaxRange_m = 30.0F;

struct Record {
  Pose2d pose;
  std::vector<float> ranges_m;
};

float bearing_of(std::size_t beam) {
  return -1.570796F + 0.017453F * static_cast<float>(beam);
}

/// ROBOTLASER1 type start fov res max accuracy remission n r*n n_rem x y theta ...
std::vector<Record> read_log() {
  std::vector<Record> records;
  for (const std::string& line : test::gz_lines(test::data_path(kLog))) {
    if (!line.starts_with("ROBOTLASER1 ")) { continue; }
    const std::vector<double> v = test::numbers_in(line.substr(12));
    if (v.size() < 192) { continue; }
    Record record;
    const auto n = static_cast<std::size_t>(v[7]);
    for (std::size_t k = 0; k < n; ++k) { record.ranges_m.push_back(static_cast<float>(v[8 + k])); }
    const std::size_t pose = 8 + n + 1;
    record.pose = {v[pose], v[pose + 1], v[pose + 2]};
    records.push_back(record);
  }
  return records;
}

using Map = RollingMap<1024, 1024>;

void draw(const Record& record, Map& map) {
  const Pose2f lidar = to_window(map.core().window(), record.pose);
  map.core().begin_scan();
  for (const bool hits : {true, false}) {
    for (std::size_t k = 0; k < record.ranges_m.size(); ++k) {
      const float range = record.ranges_m[k];
      if (range <= 0.0F || range >= kMaxRange_m) { continue; }
      const Point2f end =
          transform(lidar, {range * std::cos(bearing_of(k)), range * std::sin(bearing_of(k))});
      if (hits) {
        map.core().add_hit(end);
      } else {
        map.core().add_ray({lidar.x_m, lidar.y_m}, end, 2);
      }
    }
  }
}

TEST(BeamModelOnIntel, GivenAMapOfTheSameLogThenTheModelLearntExplainsTheScansBetter) {
  PICOLO_NEED_DATA(kLog);
  const std::vector<Record> records = read_log();
  ASSERT_EQ(records.size(), 2672U);
  double x = 0;
  double y = 0;
  for (const Record& record : records) {
    x += record.pose.x_m / static_cast<double>(records.size());
    y += record.pose.y_m / static_cast<double>(records.size());
  }
  auto map = std::make_unique<Map>();
  map->core().reset(x, y);
  for (const Record& record : records) { draw(record, *map); }

  std::vector<BeamPair> pairs;
  for (std::size_t i = 0; i < records.size(); i += 20) {
    const Pose2f lidar = to_window(map->core().window(), records[i].pose);
    for (std::size_t k = 0; k < records[i].ranges_m.size(); ++k) {
      const ExpectedRange expected = cast_ray(map->core(), lidar, bearing_of(k), kMaxRange_m);
      if (!expected.met_obstacle || expected.saw_unknown) { continue; }
      pairs.push_back({records[i].ranges_m[k], expected.range_m});
    }
  }
  ASSERT_GT(pairs.size(), 15000U);

  const BeamModel start{.max_range_m = kMaxRange_m};
  BeamModelFit fit{{.max_iterations = 500}};
  ASSERT_EQ(fit.begin(pairs, start), Status::ok);
  double before = -1e9;
  while (!fit.step()) {
    ASSERT_GE(fit.report().mean_log_likelihood, before - 1e-7);
    before = fit.report().mean_log_likelihood;
  }
  const BeamModel& model = fit.report().model;
  std::printf(
      "intel: %zu pairs, %d iterations: hit %.3f short %.3f max %.4f random %.3f sigma %.4f m "
      "rate %.3f 1/m, mean log likelihood %.3f (guess %.3f)\n",
      fit.report().pairs, fit.report().iterations, static_cast<double>(model.hit_weight),
      static_cast<double>(model.short_weight), static_cast<double>(model.max_weight),
      static_cast<double>(model.random_weight), static_cast<double>(model.sigma_m),
      static_cast<double>(model.short_rate_per_m), fit.report().mean_log_likelihood,
      static_cast<double>(scan_log_likelihood(start, pairs)) / static_cast<double>(pairs.size()));
  EXPECT_TRUE(fit.report().converged);
  EXPECT_GT(model.hit_weight, 0.7F) << "most ranges are where the map says";
  EXPECT_GT(model.sigma_m, 0.01F);
  EXPECT_LT(model.sigma_m, 0.12F) << "a laser in cells of 5 cm, grazing walls included";
  EXPECT_LT(model.max_weight, 0.1F);
  EXPECT_GT(scan_log_likelihood(model, pairs), scan_log_likelihood(start, pairs));
}

}  // namespace
}  // namespace picolo
