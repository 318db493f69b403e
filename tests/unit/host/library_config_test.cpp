// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/library_config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "picolo/host/error.hpp"
#include "support/files.hpp"

namespace picolo {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

LocaliserConfig read(const std::string& toml) {
  const TemporaryFolder folder;
  host::ConfigFile file{folder.write("c.toml", toml)};
  LocaliserConfig config;
  host::read(file, "localiser", config);
  file.reject_unknown();
  return config;
}

std::string refusal_of(const std::string& toml) {
  try {
    (void)read(toml);
  } catch (const host::UserError& error) {
    EXPECT_EQ(error.code(), host::ExitCode::usage);
    return error.what();
  }
  return "";
}

TEST(LibraryConfig, AnEmptyFileIsTheDefault) {
  const LocaliserConfig config = read("");
  EXPECT_EQ(config.fine.max_iterations, LocaliserConfig{}.fine.max_iterations);
  EXPECT_EQ(config.map.hit, LocaliserConfig{}.map.hit);
}

TEST(LibraryConfig, EveryPartIsReadFromItsOwnSection) {
  const LocaliserConfig config = read(R"([localiser]
learn_heading = false
use_surfaces = false
min_inlier_share = 0.25
insert_every_m = 0.5
insert_every_rad = 0.5
ray_stop_cells = 3
max_insert_range_m = 20.0
max_repair_tiles = 4
[localiser.map]
hit = 30
miss = -9
low = -50
high = 90
occupied_from = 20
[localiser.fine]
max_iterations = 7
min_points = 31
min_share_in_map = 0.4
converged_m = 0.002
converged_rad = 0.0003
max_step_m = 0.3
max_step_rad = 0.2
max_total_m = 2
max_total_rad = 0.7
max_condition = 900
sigma_m = 0.06
effective_points = 61
kernel_m = 0.2
inlier_m = 0.11
[localiser.noise]
translation_base_m = 0.01
translation_per_m = 0.02
translation_per_rad_m = 0.03
rotation_base_rad = 0.04
rotation_per_m_rad = 0.05
rotation_per_rad = 0.06
blind_translation_m = 0.07
blind_rotation_rad = 0.08
weight = 0.9
[localiser.search]
enabled = false
after_m = 0.4
after_rad = 0.3
below_inlier_share = 0.6
min_half_m = 0.2
max_half_m = 0.5
min_half_rad = 0.1
max_half_rad = 0.6
wide_half_m = 1.0
wide_half_rad = 2.0
wide_gain = 0.3
translation_step_m = 0.2
rotation_step_rad = 0.04
max_points = 64
max_candidates = 3
sigma_m = 0.3
prior_weight = 0.02
[localiser.heading]
scale_sigma = 0.06
per_m_sigma_rad = 0.07
scale_walk = 0.002
per_m_walk_rad = 0.003
gate_sigma = 4
[localiser.surface]
reach_m = 0.3
max_neighbours = 7
max_offset_m = 0.06
min_cosine = 0.9
)");
  EXPECT_FALSE(config.learn_heading);
  EXPECT_FALSE(config.use_surfaces);
  EXPECT_EQ(config.surface.reach_m, 0.3F);
  EXPECT_EQ(config.surface.max_neighbours, 7);
  EXPECT_EQ(config.surface.max_offset_m, 0.06F);
  EXPECT_EQ(config.surface.min_cosine, 0.9F);
  EXPECT_EQ(config.min_inlier_share, 0.25F);
  EXPECT_EQ(config.ray_stop_cells, 3);
  EXPECT_EQ(config.max_repair_tiles, 4);
  EXPECT_EQ(config.map.hit, 30);
  EXPECT_EQ(config.map.miss, -9);
  EXPECT_EQ(config.map.occupied_from, 20);
  EXPECT_EQ(config.fine.max_iterations, 7);
  EXPECT_EQ(config.fine.min_points, 31);
  EXPECT_EQ(config.fine.inlier_m, 0.11F);
  EXPECT_EQ(config.noise.translation_base_m, 0.01F);
  EXPECT_EQ(config.noise.blind_rotation_rad, 0.08F);
  EXPECT_EQ(config.noise.weight, 0.9F);
  EXPECT_FALSE(config.search.enabled);
  EXPECT_EQ(config.search.max_half_m, 0.5F);
  EXPECT_EQ(config.search.correlative.max_points, 64);
  EXPECT_EQ(config.search.correlative.score.prior_weight, 0.02F);
  EXPECT_EQ(config.heading.gate_sigma, 4.0);
}

TEST(LibraryConfig, ValuesThatDoNotFitAreRefused) {
  EXPECT_THAT(refusal_of("[localiser.fine]\nmax_iterations = 0\n"), HasSubstr("[localiser]"));
  EXPECT_THAT(refusal_of("[localiser.map]\nhit = 200\n"), HasSubstr("-128 to 127"));
  EXPECT_THAT(refusal_of("[localiser.map]\nhit = 1.5\n"), HasSubstr("whole number"));
  EXPECT_THAT(refusal_of("[localiser.nose]\nweight = 1\n"), HasSubstr("localiser.nose.weight"));
}

}  // namespace
}  // namespace picolo
