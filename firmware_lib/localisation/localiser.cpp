// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/localisation/localiser.hpp"

#include <algorithm>

#include "cell_error.hpp"
#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/geometry/angle.hpp"
#include "picolo/map/map_codec.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kPointsPerInsertStep = 4096;  // of `process`; any number gives the same map

/// A vehicle that has moved less sees the same walls in the same way: how far they may be off does
/// not change from one match to the next.
constexpr float kSameView_m = 0.15F;
constexpr float kSameView_rad = 0.3F;

/// What one ray of `map_step` stands for: so many cells walked over; one that changes is three
/// more.
constexpr std::uint32_t kWorkPerRay = 128;

std::uint32_t ray_work(const MapWork& work) {
  return work.ray_cells + 3 * work.changed_cells;
}

Matrix3f rotation_of(float theta_rad) {
  const SinCos<float> yaw = sin_cos(theta_rad);
  return {{yaw.cosine, -yaw.sine, 0.0F, yaw.sine, yaw.cosine, 0.0F, 0.0F, 0.0F, 1.0F}};
}

}  // namespace

bool LocaliserCore::usable(MatchOutcome outcome) {
  return outcome == MatchOutcome::converged || outcome == MatchOutcome::iteration_limit ||
         outcome == MatchOutcome::degenerate;
}

MapConfig coarse_map_config(const MapConfig& fine) {
  MapConfig coarse = fine;
  coarse.cell_m = fine.cell_m * static_cast<float>(kCoarseFactor);
  coarse.field_radius_cells = std::max(2, fine.field_radius_cells / 2);
  return coarse;
}

LocaliserCore::LocaliserCore(const LocaliserConfig& config, RollingMapCore& fine,
                             RollingMapCore& coarse, const SurfaceStorage& surfaces)
    : config_(config),
      fine_(fine),
      coarse_(coarse),
      surfaces_(surfaces),
      fine_matcher_(config.fine),
      searches_(config.search.correlative),
      relocaliser_(config_.relocalise, fine, coarse),
      heading_(config.heading) {}

void LocaliserCore::set_pose(const Pose2d& map_T_base, const Pose2d& odom_T_base,
                             const Matrix3f& covariance) {
  in_map_.start(covariance);
  map_T_base_ = map_T_base;
  map_T_odom_ = map_T_base * inverse(odom_T_base);
  accepted_map_T_base_ = map_T_base;
  accepted_odom_T_base_ = odom_T_base;
  if (started_ || localises_only_) { verify(true); }
}

Status LocaliserCore::begin_adopting() {
  if (phase_ != LocaliserPhase::idle) { return Status::invalid_argument; }
  place_coarse(fine_, coarse_);
  fine_.mark_all_stale();
  coarse_.mark_all_stale();
  adopted_rows_ = 0;
  has_cell_error_ = false;
  localises_only_ = true;
  verify(true);
  return Status::ok;
}

bool LocaliserCore::adopt_step(int max_tiles) {
  if (adopted_rows_ < 0) { return true; }
  for (int k = 0; k < max_tiles && adopted_rows_ < coarse_.window().height; ++k) {
    restore_coarse_row(fine_, coarse_, adopted_rows_);
    ++adopted_rows_;
  }
  if (adopted_rows_ < coarse_.window().height) { return false; }
  if (coarse_.repair(max_tiles) + fine_.repair(max_tiles) > 0) { return false; }
  adopted_rows_ = -1;
  return true;
}

Status LocaliserCore::localise_in_restored_map() {
  const Status status = begin_adopting();
  if (status != Status::ok) { return status; }
  while (!adopt_step(config_.max_repair_tiles)) {}  // at most the coarse rows plus all tiles
  return Status::ok;
}

Status LocaliserCore::begin(const UndistortedSweep& sweep, bool odometry_valid) {
  if (!config_.valid() || phase_ != LocaliserPhase::idle || adopted_rows_ >= 0) {
    return Status::invalid_argument;
  }
  sweep_ = sweep;
  const std::size_t count = sweep.points.size();
  if (config_.use_surfaces && count <= surfaces_.along_x.size()) {
    surface_directions(sweep.points, config_.surface, surfaces_.along_x, surfaces_.along_y);
    sweep_.points.along_x = surfaces_.along_x.first(count);
    sweep_.points.along_y = surfaces_.along_y.first(count);
  }
  ++counters_.sweeps;
  // Kohlbrecher's start: map_T_base(t-1) * odom_T_base(t-1)^-1 * odom_T_base(t).
  const Pose2d motion = between(accepted_odom_T_base_, sweep.odom_T_base);
  prediction_ = accepted_map_T_base_;
  if (odometry_valid) {
    prediction_ =
        accepted_map_T_base_ * (config_.learn_heading ? heading_.corrected(motion) : motion);
  }
  if (!started_ && !localises_only_) {
    started_ = true;
    fine_.reset(prediction_.x_m, prediction_.y_m);
    coarse_.reset(prediction_.x_m, prediction_.y_m);
    report_ = {};
    accepted_ = true;
    unverified_ = false;  // there is no map to compare with
    agreement_ = 1.0F;
    last_correction_ = {};
    map_T_base_ = prediction_;
    reference_ = sweep_.reference;
    accepted_map_T_base_ = prediction_;
    accepted_odom_T_base_ = sweep_.odom_T_base;
    accepted_reference_ = reference_;
    start_map_update();
    return Status::ok;
  }
  started_ = true;
  if (!localises_only_ && !map_held_) {
    fine_.follow(prediction_.x_m, prediction_.y_m);
    coarse_.follow(prediction_.x_m, prediction_.y_m);
  }
  with_odometry_ = odometry_valid;
  start_match();
  return Status::ok;
}

void LocaliserCore::start_match() {
  const PredictionNoise& noise = config_.noise;
  const float blind = square(noise.blind_translation_m);
  const Matrix3f covariance =
      with_odometry_ ? motion_covariance(between(accepted_odom_T_base_, sweep_.odom_T_base))
                     : Matrix3f::diagonal(blind, blind, square(noise.blind_rotation_rad));
  translation_sigma_m_ = square_root(std::max(covariance(0, 0), covariance(1, 1)));
  rotation_sigma_rad_ = square_root(covariance(2, 2));
  prediction_information_ = covariance_of(covariance, 0.0F);

  phase_ = LocaliserPhase::matching;
  searched_ = !config_.search.enabled;
  searched_wide_ = !config_.search.enabled;
  has_report_ = false;
  candidate_ = kMaxCandidates;
  relocalisation_ = Relocalisation::none;
  settled_ = false;
  request_ = {};
  request_.points = sweep_.points;
  request_.prior = prior_about(to_window(fine_.window(), prediction_));
  new_corners_ = new_corners_mislead();
  refine(request_.prior.pose);
}

PosePrior LocaliserCore::prior_about(const Pose2f& pose) const {
  // From base axes to those of the window.
  const Matrix3f turned = propagate(rotation_of(pose.theta_rad), prediction_information_);
  return {pose, scaled(turned, config_.noise.weight)};
}

void LocaliserCore::refine(const Pose2f& start) {
  request_.start = start;
  fine_matcher_.begin(fine_.field(), request_);
  stage_ = Stage::refine;
}

bool LocaliserCore::match_step() {
  if (phase_ != LocaliserPhase::matching) { return true; }
  if (stage_ == Stage::refine) {
    counters_.point_iterations += static_cast<std::uint32_t>(sweep_.points.size());
  }
  if (new_corners_) {  // as long as an iteration
    new_corners_ = false;
    release_new_corners();
    return false;
  }
  switch (stage_) {
    case Stage::search:
      if (!searches_.near().step(config_.search.lookups_per_step)) { return false; }
      candidate_ = 0;
      break;
    case Stage::relocalise:
      if (!relocaliser_.step(searches_.anywhere())) { return false; }
      searches_.use_near(config_.search.correlative);
      relocalisation_ = Relocalisation::refining;
      break;
    case Stage::refine:
      if (!fine_matcher_.step()) { return false; }
      if (relocalisation_ == Relocalisation::none) {
        consider(fine_matcher_.report());
      } else {
        judge_place(fine_matcher_.report());
      }
      break;
  }
  if (next_candidate() || begin_search() || begin_wide_search() || begin_relocalisation() ||
      next_place()) {
    return false;
  }
  conclude();
  return true;
}

bool LocaliserCore::sees_the_same() const {
  const Pose2f& now = report_.pose;
  const Pose2f& then = cell_error_from_;
  return has_cell_error_ && hypotenuse(now.x_m - then.x_m, now.y_m - then.y_m) <= kSameView_m &&
         magnitude(now.theta_rad - then.theta_rad) <= kSameView_rad;
}

void LocaliserCore::conclude() {
  ++counters_.outcomes[static_cast<std::size_t>(report_.outcome)];
  accepted_ = usable(report_.outcome) && report_.inlier_share >= config_.min_inlier_share;
  reference_ = sweep_.reference;
  agreement_ = 0.0F;
  if (accepted_ && (!(doubted_ && unverified_) || proves_by_way())) {
    const bool poor = report_.inlier_share < config_.search.below_inlier_share;
    agreement_ = doubted_ || poor ? agreement_of(report_) : report_.inlier_share;
  }
  note_fit();
  if (!accepted_) {
    ++counters_.rejected;
    map_T_base_ = prediction_;
    phase_ = LocaliserPhase::idle;
    return;
  }
  ++counters_.matched;
  map_T_base_ = to_map(fine_.window(), report_.pose);
  if (doubted_ && proves_by_way()) { prove_by_way(); }
  last_correction_ = to_f32(between(prediction_, map_T_base_));
  map_T_odom_ = map_T_base_ * inverse(sweep_.odom_T_base);
  if (config_.learn_heading && with_odometry_ && !guessed_ && !settled_) {
    const Pose2d motion = between(accepted_odom_T_base_, sweep_.odom_T_base);
    const double turn = between(accepted_map_T_base_, map_T_base_).theta_rad;
    heading_.update(motion, turn, static_cast<double>(report_.covariance(2, 2)) + 1e-4);
  }
  // The walls of a given map and of one that this match founds; later the map is what it is.
  const bool walls_count = localises_only_ || counters_.matched == 1;
  if (walls_count && !sees_the_same()) {
    cell_error_ = cell_error(sweep_.points, report_, fine_.config().cell_m);
    cell_error_from_ = report_.pose;
    has_cell_error_ = true;
  }
  // Beside it, not below: the stack.
  update_uncertainty(walls_count ? cell_error_ : Matrix3f{});
  accepted_map_T_base_ = map_T_base_;
  accepted_odom_T_base_ = sweep_.odom_T_base;
  accepted_reference_ = reference_;
  const Pose2d since = between(last_inserted_, map_T_base_);
  const double turn = magnitude(since.theta_rad);
  const double way_m = hypotenuse(since.x_m, since.y_m);
  const bool near = way_m < static_cast<double>(config_.insert_every_m) &&
                    turn < static_cast<double>(config_.insert_every_rad);
  if (near || map_held_ || localises_only_) {
    phase_ = LocaliserPhase::idle;
    return;
  }
  start_map_update();
}

void LocaliserCore::start_map_update() {
  phase_ = LocaliserPhase::mapping;
  last_inserted_ = map_T_base_;
  fine_.begin_scan();
  coarse_.begin_scan();
  next_point_ = 0;
  adding_hits_ = true;
  ++counters_.inserted;
  const Pose2f from = to_f32(map_T_base_);
  if (counters_.inserted == 1) { mapped_from_ = mapped_to_ = {from.x_m, from.y_m}; }
  mapped_from_ = {std::min(mapped_from_.x_m, from.x_m), std::min(mapped_from_.y_m, from.y_m)};
  mapped_to_ = {std::max(mapped_to_.x_m, from.x_m), std::max(mapped_to_.y_m, from.y_m)};
}

void LocaliserCore::add_points(std::size_t max_points, bool hits) {
  std::size_t end = std::min(sweep_.points.size(), next_point_ + max_points);
  const std::uint32_t before = ray_work(fine_.work());
  for (RollingMapCore* map : {&fine_, &coarse_}) {
    const Pose2f window_T_base = to_window(map->window(), map_T_base_);
    const SinCos<float> yaw = sin_cos(window_T_base.theta_rad);
    const auto place = [&](Point2f p) {
      return Point2f{window_T_base.x_m + (yaw.cosine * p.x_m - yaw.sine * p.y_m),
                     window_T_base.y_m + (yaw.sine * p.x_m + yaw.cosine * p.y_m)};
    };
    const Point2f first = place(sweep_.lidar_at_first_m);
    const Point2f last = place(sweep_.lidar_at_last_m);
    const float per_point =
        1.0F / static_cast<float>(std::max<std::size_t>(1, sweep_.points.size()));
    const float limit = square(config_.max_insert_range_m);
    for (std::size_t k = next_point_; k < end; ++k) {
      const Point2f p{sweep_.points.x_m[k], sweep_.points.y_m[k]};
      if (square(p.x_m) + square(p.y_m) > limit) { continue; }
      if (hits) {
        map->add_hit(place(p));
        continue;
      }
      const float share = static_cast<float>(k) * per_point;
      map->add_ray(
          {first.x_m + share * (last.x_m - first.x_m), first.y_m + share * (last.y_m - first.y_m)},
          place(p), map == &fine_ ? config_.ray_stop_cells : 1);
      if (map == &fine_ && ray_work(fine_.work()) - before >= kWorkPerRay * max_points) {
        end = k + 1;
      }
    }
  }
  next_point_ = end;
}

bool LocaliserCore::map_step(std::size_t max_rays) {
  if (phase_ != LocaliserPhase::mapping) { return true; }
  if (next_point_ < sweep_.points.size()) {
    add_points(max_rays, adding_hits_);
    return false;
  }
  if (adding_hits_) {
    adding_hits_ = false;
    next_point_ = 0;
    return false;
  }
  fine_.repair(config_.max_repair_tiles);
  coarse_.repair(config_.max_repair_tiles);
  if (fine_.stale_tiles() + coarse_.stale_tiles() > 0) { return false; }
  phase_ = LocaliserPhase::idle;
  return true;
}

Status LocaliserCore::process(const UndistortedSweep& sweep, bool odometry_valid) {
  const Status status = begin(sweep, odometry_valid);
  if (status != Status::ok) { return status; }
  while (!match_step()) {}                    // at most the matchers' iteration limits
  while (!map_step(kPointsPerInsertStep)) {}  // at most the points plus the stale tiles
  return Status::ok;
}

}  // namespace picolo::inline v0
