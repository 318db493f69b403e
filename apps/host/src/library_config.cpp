// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/library_config.hpp"

#include <cstdint>
#include <limits>

#include "picolo/host/error.hpp"

namespace picolo::host {
namespace {

void read_small(ConfigFile& file, const std::string& section, const std::string& key,
                std::int8_t& value) {
  int wide = value;
  file.read(section, key, wide);
  if (wide < std::numeric_limits<std::int8_t>::min() ||
      wide > std::numeric_limits<std::int8_t>::max()) {
    throw UserError{ExitCode::usage, "", "[" + section + "] " + key + " is out of range",
                    "give a number from -128 to 127"};
  }
  value = static_cast<std::int8_t>(wide);
}

void read_map(ConfigFile& file, const std::string& section, MapConfig& map) {
  read_small(file, section, "hit", map.hit);
  read_small(file, section, "miss", map.miss);
  read_small(file, section, "low", map.low);
  read_small(file, section, "high", map.high);
  read_small(file, section, "occupied_from", map.occupied_from);
}

void read_matcher(ConfigFile& file, const std::string& section, GaussNewtonConfig& matcher) {
  file.read(section, "max_iterations", matcher.max_iterations);
  file.read(section, "min_points", matcher.min_points);
  file.read(section, "min_share_in_map", matcher.min_share_in_map);
  file.read(section, "converged_m", matcher.converged_m);
  file.read(section, "converged_rad", matcher.converged_rad);
  file.read(section, "max_step_m", matcher.max_step_m);
  file.read(section, "max_step_rad", matcher.max_step_rad);
  file.read(section, "max_total_m", matcher.max_total_m);
  file.read(section, "max_total_rad", matcher.max_total_rad);
  file.read(section, "max_condition", matcher.max_condition);
  file.read(section, "sigma_m", matcher.sigma_m);
  file.read(section, "effective_points", matcher.effective_points);
  file.read(section, "kernel_m", matcher.kernel_m);
  file.read(section, "inlier_m", matcher.inlier_m);
}

void read_noise(ConfigFile& file, const std::string& section, PredictionNoise& noise) {
  file.read(section, "translation_base_m", noise.translation_base_m);
  file.read(section, "translation_per_m", noise.translation_per_m);
  file.read(section, "translation_per_rad_m", noise.translation_per_rad_m);
  file.read(section, "rotation_base_rad", noise.rotation_base_rad);
  file.read(section, "rotation_per_m_rad", noise.rotation_per_m_rad);
  file.read(section, "rotation_per_rad", noise.rotation_per_rad);
  file.read(section, "blind_translation_m", noise.blind_translation_m);
  file.read(section, "blind_rotation_rad", noise.blind_rotation_rad);
  file.read(section, "weight", noise.weight);
}

void read_search(ConfigFile& file, const std::string& section, SearchConfig& search) {
  file.read(section, "enabled", search.enabled);
  file.read(section, "after_m", search.after_m);
  file.read(section, "after_rad", search.after_rad);
  file.read(section, "below_inlier_share", search.below_inlier_share);
  file.read(section, "min_half_m", search.min_half_m);
  file.read(section, "max_half_m", search.max_half_m);
  file.read(section, "min_half_rad", search.min_half_rad);
  file.read(section, "max_half_rad", search.max_half_rad);
  file.read(section, "wide_half_m", search.wide_half_m);
  file.read(section, "wide_half_rad", search.wide_half_rad);
  file.read(section, "wide_gain", search.wide_gain);
  CorrelativeConfig& correlative = search.correlative;
  file.read(section, "translation_step_m", correlative.translation_step_m);
  file.read(section, "rotation_step_rad", correlative.rotation_step_rad);
  file.read(section, "max_points", correlative.max_points);
  file.read(section, "max_candidates", correlative.max_candidates);
  file.read(section, "sigma_m", correlative.score.sigma_m);
  file.read(section, "prior_weight", correlative.score.prior_weight);
}

void read_heading(ConfigFile& file, const std::string& section, HeadingCorrectionConfig& heading) {
  file.read(section, "scale_sigma", heading.scale_sigma);
  file.read(section, "per_m_sigma_rad", heading.per_m_sigma_rad);
  file.read(section, "scale_walk", heading.scale_walk);
  file.read(section, "per_m_walk_rad", heading.per_m_walk_rad);
  file.read(section, "gate_sigma", heading.gate_sigma);
}

void read_surface(ConfigFile& file, const std::string& section, SurfaceConfig& surface) {
  file.read(section, "reach_m", surface.reach_m);
  file.read(section, "max_neighbours", surface.max_neighbours);
  file.read(section, "sparse_m", surface.sparse_m);
  file.read(section, "max_offset_m", surface.max_offset_m);
  file.read(section, "min_cosine", surface.min_cosine);
}

void read_uncertainty(ConfigFile& file, const std::string& section, UncertaintyConfig& config) {
  file.read(section, "max_condition", config.max_condition);
  file.read(section, "residual_factor", config.residual_factor);
  file.read(section, "founding_factor", config.founding_factor);
  file.read(section, "renewal_per_m", config.renewal_per_m);
  file.read(section, "receding_m", config.receding_m);
  OdometryNoise& odometry = config.odometry;
  file.read(section + ".odometry", "walk_m", odometry.walk_m);
  file.read(section + ".odometry", "walk_persists_m", odometry.walk_persists_m);
  file.read(section + ".odometry", "heading_walk_rad", odometry.heading_walk_rad);
  file.read(section + ".odometry", "sideways_m", odometry.sideways_m);
  file.read(section + ".odometry", "scale", odometry.scale);
  file.read(section + ".odometry", "heading_per_m_rad", odometry.heading_per_m_rad);
  file.read(section + ".odometry", "heading_per_s_rad", odometry.heading_per_s_rad);
  file.read(section + ".odometry", "heading_scale", odometry.heading_scale);
}

}  // namespace

void read(ConfigFile& file, const std::string& section, LocaliserConfig& config) {
  read_uncertainty(file, section + ".uncertainty", config.uncertainty);
  read_map(file, section + ".map", config.map);
  read_matcher(file, section + ".fine", config.fine);
  read_noise(file, section + ".noise", config.noise);
  read_search(file, section + ".search", config.search);
  read_heading(file, section + ".heading", config.heading);
  read_surface(file, section + ".surface", config.surface);
  file.read(section, "use_surfaces", config.use_surfaces);
  file.read(section, "learn_heading", config.learn_heading);
  file.read(section, "min_inlier_share", config.min_inlier_share);
  file.read(section, "insert_every_m", config.insert_every_m);
  file.read(section, "insert_every_rad", config.insert_every_rad);
  file.read(section, "ray_stop_cells", config.ray_stop_cells);
  file.read(section, "max_insert_range_m", config.max_insert_range_m);
  file.read(section, "max_repair_tiles", config.max_repair_tiles);
  if (!config.valid()) {
    throw UserError{ExitCode::usage, "", "the values of [" + section + "] do not fit together",
                    "see LocaliserConfig::valid() for the domain of each"};
  }
}

}  // namespace picolo::host
