// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The heart: prediction, match, acceptance, map update.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/math.hpp"
#include "picolo/core/status.hpp"
#include "picolo/geometry/pose2.hpp"
#include "picolo/localisation/profile.hpp"
#include "picolo/localisation/relocaliser.hpp"
#include "picolo/localisation/search_memory.hpp"
#include "picolo/map/rolling_map.hpp"
#include "picolo/matching/gauss_newton.hpp"
#include "picolo/matching/surface.hpp"
#include "picolo/odometry/heading_correction.hpp"
#include "picolo/odometry/motion_uncertainty.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

/// How far the prediction may be off: along the way sigma^2 = base^2 + (per_m d)^2 + (per_rad
/// dtheta)^2 over the motion since the last match, the same for the rotation; across it the
/// rotation's error carries the end sideways. Without odometry the two `blind` values hold about
/// the last pose.
struct PredictionNoise {
  float translation_base_m = 0.03F;
  float translation_per_m = 0.10F;
  float translation_per_rad_m = 0.06F;
  float rotation_base_rad = 0.02F;
  float rotation_per_m_rad = 0.08F;
  float rotation_per_rad = 0.15F;
  float blind_translation_m = 0.3F;  ///< tight ones hold a vehicle back that moves on steadily
  float blind_rotation_rad = 0.12F;
  float guessed_translation_m = 0.1F;  ///< added where the odometry is a guess of steady motion
  float guessed_rotation_rad = 0.05F;
  /// Of the odometry term against the scan. Directions that the scan leaves open are the odometry's
  /// whatever the weight.
  float weight = 0.2F;
};

/// When the start may be too far off for Gauss-Newton: correlative search first, the best
/// candidates refined beside the prediction.
struct SearchConfig {
  bool enabled = true;
  float after_m = 0.3F;  ///< of motion since the last match
  float after_rad = 0.25F;
  float below_inlier_share = 0.5F;  ///< or when the refined prediction fits this badly
  float min_half_m = 0.3F;  ///< the window: three sigma of the prediction, within these limits
  float max_half_m = 0.6F;
  float min_half_rad = 0.1745F;
  float max_half_rad = 0.6109F;
  float wide_half_m = 1.2F;  ///< after a glitch of the odometry: about the last pose
  float wide_half_rad = 2.0944F;
  /// While the pose is doubted (see LocaliserCore::doubt): search wide, in steps twice as long, for
  /// every sweep of which fewer points fit, and take the better one.
  float doubted_inlier_share = 0.85F;
  float wide_gain = 0.2F;  ///< a wide match is taken only when it fits so much more of the points
  std::size_t lookups_per_step = 8192;
  CorrelativeConfig correlative{
      .score = {.prior_weight = 0.03F}};  ///< the prior carries its weight already
  [[nodiscard]] constexpr bool valid() const {
    return after_m >= 0.0F && after_rad >= 0.0F && min_half_m > 0.0F && max_half_m >= min_half_m &&
           min_half_rad > 0.0F && max_half_rad >= min_half_rad && wide_half_m > 0.0F &&
           wide_half_rad > 0.0F && wide_half_rad <= 3.1416F && wide_gain >= 0.0F &&
           doubted_inlier_share >= 0.0F && doubted_inlier_share <= 1.0F && lookups_per_step > 0 &&
           correlative.valid();
  }
};

/// What the published covariances are made of; no pose depends on it.
struct UncertaintyConfig {
  OdometryNoise odometry{};
  /// A direction that the scan constrains less than this below its best says nothing of its error:
  /// noise of the normals feigns as much.
  float max_condition = 20.0F;
  /// Of a match: the residuals' variance, so often, over the information of all points:
  /// neighbouring beams and the stairs of oblique walls err together.
  float residual_factor = 0.28F;
  /// Of a map that one scan has founded, in multiples of a match's covariance, ...
  float founding_factor = 17.0F;
  float renewal_per_m = 6.9F;  ///< ... and what each metre adds to it, as the view is renewed
  float receding_m = 0.006F;   ///< walls seen from one side only move away in it: after 1 m
  [[nodiscard]] constexpr bool valid() const {
    return odometry.valid() && max_condition > 1.0F && residual_factor > 0.0F &&
           founding_factor >= 0.0F && renewal_per_m >= 0.0F && receding_m >= 0.0F;
  }
};

struct LocaliserConfig {
  MapConfig map{};  ///< of the fine grid; cell size and field radius come from the profile
  /// The iterations bound the slowest match (docs/matching.md). With odometry to fall back on, more
  /// directions may be left to it than by a matcher alone.
  GaussNewtonConfig fine{.max_iterations = 10, .max_condition = 40.0F};
  PredictionNoise noise{};
  SearchConfig search{};
  RelocaliseConfig relocalise{};
  SurfaceConfig surface{};
  HeadingCorrectionConfig heading{};
  UncertaintyConfig uncertainty{};
  bool use_surfaces = true;   ///< points constrain across their surface only
  bool learn_heading = true;  ///< correct the odometry's heading by what matches taught
  /// A match with fewer points near known obstacles may not move the pose nor the map.
  float min_inlier_share = 0.30F;
  /// A scan enters the map only after this much motion since the last that did, ...
  float insert_every_m = 0.0F;
  float insert_every_rad = 0.0F;  ///< ... or this much turn
  int ray_stop_cells = 2;         ///< rays clear cells up to this many short of their end
  float max_insert_range_m = 30.0F;
  int max_repair_tiles = 8;  ///< of the field, in one map step
  [[nodiscard]] constexpr bool valid() const {
    return map.valid() && fine.valid() && min_inlier_share >= 0.0F && min_inlier_share <= 1.0F &&
           insert_every_m >= 0.0F && insert_every_rad >= 0.0F && ray_stop_cells >= 0 &&
           noise.weight >= 0.0F && heading.valid() && search.valid() && relocalise.valid() &&
           surface.valid() && uncertainty.valid() && max_insert_range_m > 0.0F &&
           max_repair_tiles > 0;
  }
};

static_assert(LocaliserConfig{}.valid());

struct LocaliserCounters {
  std::uint32_t sweeps = 0;
  std::uint32_t matched = 0;  ///< accepted, the first sweep not counted
  std::uint32_t rejected = 0;
  std::uint32_t searched = 0;           ///< sweeps with a correlative search
  std::uint32_t searched_wide = 0;      ///< of these, with a wide one
  std::uint32_t searched_anywhere = 0;  ///< ... or with one of the whole map, ...
  std::uint32_t found_anywhere = 0;     ///< ... which found the one place that it fits
  std::uint32_t inserted = 0;           ///< sweeps that entered the map
  std::uint32_t point_iterations = 0;   ///< points walked by iterations and for new corners; modulo
                                        ///< 2^32
  std::uint32_t outcomes[kMatchOutcomes] = {};  ///< of the fine match, by MatchOutcome
};

/// Working memory, one element a point.
struct SurfaceStorage {
  std::span<std::int8_t> along_x;
  std::span<std::int8_t> along_y;
};

/// Where the localiser stands with the current sweep.
enum class LocaliserPhase : std::uint8_t { idle, matching, mapping };

/// Matches undistorted sweeps against the map that it builds. Work comes in bounded slices:
/// `begin`, `match_step` until it returns true (then map_T_odom is corrected), `map_step` until it
/// returns true (then the next sweep may begin); `process` is that loop. Context: cycle only. The
/// points of the sweep must stay valid until the last slice.
class LocaliserCore {
 public:
  LocaliserCore(const LocaliserConfig& config, RollingMapCore& fine, RollingMapCore& coarse,
                const SurfaceStorage& surfaces);

  /// Where the vehicle stands at the first sweep; afterwards a jump of the pose (the map is kept).
  /// `covariance`: of map_T_base, map axes.
  void set_pose(const Pose2d& map_T_base, const Pose2d& odom_T_base,
                const Matrix3f& covariance = {});

  /// `odometry_valid`: sweep.odom_T_base is real; otherwise the pose is predicted to stand still.
  /// `invalid_argument`: configuration, or a sweep is still being worked on.
  Status begin(const UndistortedSweep& sweep, bool odometry_valid);
  /// The odometry of the sweeps to come is a guess of steady motion, not a measurement.
  void predict_loosely(bool guessed) { guessed_ = guessed; }
  [[nodiscard]] bool predicts_loosely() const { return guessed_; }
  /// One slice: a Gauss-Newton iteration, a walk over the points that is as long, or
  /// `search.lookups_per_step` lookups of a search. True when the match is over.
  bool match_step();
  /// Up to `max_rays` beams into the map, fewer where they are long or clear what nobody saw
  /// before; then repairs of the field. True when the sweep is done.
  bool map_step(std::size_t max_rays);
  /// All slices at once, for host users.
  Status process(const UndistortedSweep& sweep, bool odometry_valid);

  [[nodiscard]] LocaliserPhase phase() const { return phase_; }
  /// The next `match_step` is a slice of a search; callers may want to run that as background work.
  [[nodiscard]] bool searching() const {
    return phase_ == LocaliserPhase::matching &&
           (stage_ == Stage::search || stage_ == Stage::relocalise);
  }
  /// The whole map is being searched for the sweep at hand.
  [[nodiscard]] bool relocalising() const { return relocalisation_ == Relocalisation::searching; }
  /// The last sweep whose match is over was found by that.
  [[nodiscard]] bool relocalised() const { return settled_; }
  /// The last search of the whole map found two places that the sweep fits alike.
  [[nodiscard]] bool ambiguous() const { return ambiguous_; }
  /// While held, accepted matches correct the pose but no sweep enters the map: what is seen from a
  /// pose that is in doubt would be believed for ever. The first sweep founds the map all the same.
  void hold_map(bool held) { map_held_ = held; }
  /// Takes over the map that the caller has restored into `restorable_map`: from then on no sweep
  /// founds or changes it, and its window stays. In slices: `begin_adopting`, then `adopt_step`
  /// until it returns true; no sweep may begin meanwhile. Afterwards `set_pose`, then sweeps as
  /// ever. `invalid_argument`: a sweep is being worked on.
  Status begin_adopting();
  /// Cost: `max_tiles` rows of the coarse map, or tiles of the field.
  bool adopt_step(int max_tiles);
  /// All slices at once, for start-up.
  Status localise_in_restored_map();
  [[nodiscard]] RollingMapCore& restorable_map() { return fine_; }
  [[nodiscard]] bool localises_only() const { return localises_only_; }
  /// While doubted, the pose may be far from the truth: what fits badly near it is searched for in
  /// the whole map (see RelocaliseConfig), or widely where that is switched off.
  void doubt(bool doubted) { doubted_ = doubted; }
  /// The pose may be anywhere, or nowhere near: while doubted, the next sweeps are searched for in
  /// the whole map even where they fit, until one fits at one place only; or, in a large map (see
  /// RelocaliseConfig), the vehicle drives on and all of them fit. `given`: somebody who knows has
  /// set the pose; where it fits as well as any other, it is that.
  void verify(bool given) {
    unverified_ = config_.relocalise.enabled;
    given_ = given;
    proof_way_m_ = 0.0F;
  }
  [[nodiscard]] bool unverified() const { return unverified_; }
  /// Of the points that the map has an opinion on, the share that is near an obstacle; 0 as long as
  /// it is to be verified. Looked up for accepted matches while doubted; the inlier share
  /// otherwise.
  [[nodiscard]] float agreement() const { return agreement_; }
  /// Of the last sweep whose match is over.
  [[nodiscard]] const MatchReport& report() const { return report_; }
  [[nodiscard]] bool accepted() const { return accepted_; }
  /// map_T_base at the reference instant of the last sweep whose match is over.
  [[nodiscard]] const Pose2d& map_T_base() const { return map_T_base_; }
  [[nodiscard]] Timestamp reference() const { return reference_; }
  [[nodiscard]] const Pose2d& map_T_odom() const { return map_T_odom_; }
  /// Of map_T_base at the last accepted match, given the map, map axes. Directions that the scan
  /// leaves open gather the odometry's error for as long as the map is a given one; while it is
  /// being built, that error is the map's: drift.
  [[nodiscard]] Matrix3f match_covariance() const {
    return sum(in_map_.covariance(), in_map_error_);
  }
  /// Of the map, where the vehicle is, against the start, map axes. Zero in a given map.
  [[nodiscard]] Matrix3f drift_covariance() const { return drift_.covariance(); }
  [[nodiscard]] const HeadingCorrection& heading() const { return heading_; }
  /// By how much the last accepted match moved the prediction, in base.
  [[nodiscard]] const Pose2f& last_correction() const { return last_correction_; }
  [[nodiscard]] const LocaliserCounters& counters() const { return counters_; }
  [[nodiscard]] const RollingMapCore& map() const { return fine_; }
  [[nodiscard]] const RollingMapCore& coarse_map() const { return coarse_; }
  [[nodiscard]] const LocaliserConfig& config() const { return config_; }

 private:
  /// What one slice of the match does.
  enum class Stage : std::uint8_t { refine, search, relocalise };
  /// Of the sweep at hand, in the whole map.
  enum class Relocalisation : std::uint8_t { none, searching, refining, settling, over };

  /// Where a point lies: beyond the inlier distance, in a cell that was seen clear, or of which the
  /// map knows nothing; or anywhere else.
  enum class Ground : std::uint8_t { other, clear, unseen };
  struct Sighting {
    FieldSample at;
    Ground ground;
  };
  [[nodiscard]] Sighting sight(const Pose2f& pose, const SinCos<float>& yaw, std::size_t k) const;

  [[nodiscard]] static bool usable(MatchOutcome outcome);
  void start_match();
  [[nodiscard]] bool new_corners_mislead() const;
  void release_new_corners();
  void refine(const Pose2f& start);
  void consider(const MatchReport& report);
  [[nodiscard]] float agreement_of(const MatchReport& report) const;
  [[nodiscard]] bool fits() const;
  [[nodiscard]] bool worth_a_search() const;
  [[nodiscard]] bool begin_search();
  [[nodiscard]] bool begin_wide_search();
  [[nodiscard]] bool next_candidate();
  [[nodiscard]] bool begin_relocalisation();
  void judge_place(const MatchReport& report);
  [[nodiscard]] bool next_place();
  [[nodiscard]] bool choose_place();
  [[nodiscard]] bool stays() const;
  void note_fit();
  [[nodiscard]] bool searches_slowly() const;
  [[nodiscard]] bool proves_by_way() const;
  void prove_by_way();
  [[nodiscard]] Matrix3f motion_covariance(const Pose2d& motion) const;
  [[nodiscard]] PosePrior prior_about(const Pose2f& pose) const;
  /// From where cell_error_ was found.
  [[nodiscard]] bool sees_the_same() const;
  void conclude();
  void update_uncertainty(const Matrix3f& cell_gradients);
  [[nodiscard]] std::array<float, 3> receding_gradient() const;
  void start_map_update();
  void add_points(std::size_t max_points, bool hits);

  LocaliserConfig config_;
  RollingMapCore& fine_;
  RollingMapCore& coarse_;
  SurfaceStorage surfaces_;
  GaussNewtonMatcher<DistanceFieldView> fine_matcher_;
  UndistortedSweep sweep_{};
  SearchMemory searches_;
  Relocaliser relocaliser_;
  MatchRequest request_{};
  MatchReport report_{};
  Matrix3f report_prior_{};  // information of the prediction that it used; searches use none
  Matrix3f prediction_information_{};  // base axes, without its weight
  float translation_sigma_m_ = 0.0F;
  float rotation_sigma_rad_ = 0.0F;
  std::size_t candidate_ = 0;
  std::size_t place_ = 0;  // of the relocaliser, that is refined
  Relocalisation relocalisation_ = Relocalisation::none;
  Stage stage_ = Stage::refine;
  bool new_corners_ = false;  // are to be released before the first iteration
  bool searched_ = false;
  bool searched_wide_ = false;
  bool has_report_ = false;
  LocaliserPhase phase_ = LocaliserPhase::idle;
  Pose2d prediction_{};
  Pose2d map_T_base_{};
  Pose2d map_T_odom_{};
  Pose2d accepted_map_T_base_{};   // at the last accepted match, with ...
  Pose2d accepted_odom_T_base_{};  // ... the odometry at its instant
  HeadingCorrection heading_;
  MotionUncertainty in_map_{};
  Matrix3f in_map_error_{};   // what all sweeps here have in common: the map's cells
  Matrix3f cell_error_{};     // of the gradients, seen from the pose below
  Pose2f cell_error_from_{};  // window axes
  bool has_cell_error_ = false;
  MotionUncertainty drift_{};
  Pose2d last_inserted_{};
  Pose2f last_correction_{};
  Timestamp reference_{};
  Timestamp accepted_reference_{};
  bool started_ = false;
  bool with_odometry_ = false;
  bool accepted_ = false;
  bool adding_hits_ = false;
  bool map_held_ = false;
  bool doubted_ = false;
  bool ambiguous_ = false;
  bool settled_ = false;
  bool guessed_ = false;
  bool unverified_ = false;
  bool given_ = false;
  float proof_way_m_ = 0.0F;
  Point2f mapped_from_{};  // corners of the square from which the map was made
  Point2f mapped_to_{};
  int unfit_in_a_row_ = 0;  // doubted sweeps
  float agreement_ = 0.0F;
  bool localises_only_ = false;
  int adopted_rows_ = -1;  // of the coarse map; -1: no map is being adopted
  std::size_t next_point_ = 0;
  LocaliserCounters counters_{};
};

/// The map configuration of a profile, other fields from `base`.
template <Profile P>
[[nodiscard]] constexpr MapConfig fine_map_config(MapConfig base) {
  base.cell_m = P::kCell_m;
  base.field_radius_cells = P::kFieldRadius;
  return base;
}
[[nodiscard]] MapConfig coarse_map_config(const MapConfig& fine);

/// Maps and localiser of a profile.
template <Profile P>
class Localiser {
 public:
  explicit Localiser(const LocaliserConfig& config = {})
      : fine_(fine_map_config<P>(config.map)),
        coarse_(coarse_map_config(fine_map_config<P>(config.map))),
        core_(config, fine_.core(), coarse_.core(), {along_x_, along_y_}) {}
  Localiser(const Localiser&) = delete;
  Localiser& operator=(const Localiser&) = delete;
  ~Localiser() = default;

  [[nodiscard]] LocaliserCore& core() { return core_; }
  [[nodiscard]] const LocaliserCore& core() const { return core_; }

 private:
  RollingMap<P::kWidth, P::kHeight> fine_;
  RollingMap<P::kWidth / kCoarseFactor, P::kHeight / kCoarseFactor> coarse_;
  std::array<std::int8_t, P::kReturns> along_x_{};
  std::array<std::int8_t, P::kReturns> along_y_{};
  LocaliserCore core_;
};

}  // namespace picolo::inline v0
