// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "scan_matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "picolo/host/error.hpp"
#include "picolo/matching/correlative.hpp"
#include "picolo/matching/gauss_newton.hpp"
#include "picolo/matching/levenberg_marquardt.hpp"
#include "picolo/matching/surface.hpp"

namespace picolo::tool {
namespace {

/// The sweep's points with the directions of their surfaces, as the localiser matches them.
class Surfaces {
 public:
  explicit Surfaces(const SurfaceConfig& config) : config_{config} {}

  /// Valid until the next call.
  PointsView of(const PointsView& points) {
    surface_directions(points, config_, along_x_, along_y_);
    PointsView with = points;
    with.along_x = std::span{along_x_}.first(points.size());
    with.along_y = std::span{along_y_}.first(points.size());
    return with;
  }

 private:
  SurfaceConfig config_;
  std::array<std::int8_t, SiteProfile::kReturns> along_x_{};
  std::array<std::int8_t, SiteProfile::kReturns> along_y_{};
};

/// Gauss-Newton or Levenberg-Marquardt from the guess.
template <typename Matcher>
class FieldMatcher final : public ScanMatcher {
 public:
  FieldMatcher(const Matcher& matcher, const LocaliserConfig& config, RollingMapCore& map)
      : matcher_{matcher},
        surfaces_{config.surface},
        prior_weight_{config.noise.weight},
        map_{map} {}

  void follow(const Pose2d& /*map_T_base*/) override {}
  ScanMatch match(const UndistortedSweep& sweep, const Pose2d& guess,
                  const GuessSigma& sigma) override {
    MatchRequest request{.points = surfaces_.of(sweep.points),
                         .start = to_window(map_.window(), guess)};
    request.prior = prior_of(request.start, sigma, prior_weight_);
    const MatchReport report = matcher_.match(map_.field(), request);
    return {report, to_map(map_.window(), report.pose), report.covariance};
  }
  void add(const UndistortedSweep& /*sweep*/, const Pose2d& /*map_T_base*/) override {}

 private:
  Matcher matcher_;
  Surfaces surfaces_;
  float prior_weight_;
  RollingMapCore& map_;
};

/// The best pose of a window about the guess, then refined by Gauss-Newton: the steps of the search
/// are coarser than what a map can tell.
class SearchMatcher final : public ScanMatcher {
 public:
  SearchMatcher(const LocaliserConfig& config, RollingMapCore& map)
      : config_{config},
        search_{config.search.correlative},
        refiner_{config.fine},
        surfaces_{config.surface},
        map_{map} {}

  void follow(const Pose2d& /*map_T_base*/) override {}
  ScanMatch match(const UndistortedSweep& sweep, const Pose2d& guess,
                  const GuessSigma& sigma) override {
    const SearchConfig& limits = config_.search;
    const DistanceFieldView field = map_.field();
    const Pose2f start = to_window(map_.window(), guess);
    const PosePrior prior = prior_of(start, sigma, config_.noise.weight);
    const SearchWindow window{
        .centre = start,
        .half_translation_m =
            std::clamp(3.0F * sigma.translation_m, limits.min_half_m, limits.max_half_m),
        .half_rotation_rad =
            std::clamp(3.0F * sigma.rotation_rad, limits.min_half_rad, limits.max_half_rad)};
    MatchRequest request{.points = surfaces_.of(sweep.points), .start = start, .prior = prior};
    if (search_.search(field, sweep.points, window, prior) == Status::ok &&
        !search_.candidates().empty()) {
      request.start = search_.candidates().front().pose;
    }
    const MatchReport report = refiner_.match(field, request);
    return {report, to_map(map_.window(), report.pose), report.covariance};
  }
  void add(const UndistortedSweep& /*sweep*/, const Pose2d& /*map_T_base*/) override {}

 private:
  LocaliserConfig config_;
  CorrelativeSearch search_;
  GaussNewtonMatcher<DistanceFieldView> refiner_;
  Surfaces surfaces_;
  RollingMapCore& map_;
};

}  // namespace

MatcherKind matcher_kind(const std::string& name) {
  if (name == "gn") { return MatcherKind::gn; }
  if (name == "lm") { return MatcherKind::lm; }
  if (name == "ndt") { return MatcherKind::ndt; }
  if (name == "correlative") { return MatcherKind::correlative; }
  if (name == "plicp") { return MatcherKind::plicp; }
  throw host::UserError{host::ExitCode::usage, "", "unknown matcher '" + name + "'",
                        std::string{"choose "} + kMatcherNames};
}

const char* title_of(MatcherKind kind) {
  switch (kind) {
    case MatcherKind::gn: return "Gauss-Newton";
    case MatcherKind::lm: return "Levenberg-Marquardt";
    case MatcherKind::ndt: return "normal distributions";
    case MatcherKind::correlative: return "correlative search";
    case MatcherKind::plicp: break;
  }
  return "point-to-line ICP";
}

bool is_pose(MatchOutcome outcome) {
  return outcome == MatchOutcome::converged || outcome == MatchOutcome::iteration_limit ||
         outcome == MatchOutcome::degenerate;
}

PosePrior prior_of(const Pose2f& window_T_guess, const GuessSigma& sigma, float weight) {
  const float along = weight / (sigma.translation_m * sigma.translation_m);
  return {window_T_guess,
          Matrix3f::diagonal(along, along, weight / (sigma.rotation_rad * sigma.rotation_rad))};
}

void insert_scan(RollingMapCore& map, const UndistortedSweep& sweep, const Pose2d& map_T_base,
                 const LocaliserConfig& config) {
  const Pose2f at = to_window(map.window(), map_T_base);
  const float c = std::cos(at.theta_rad);
  const float s = std::sin(at.theta_rad);
  const auto place = [&](float x_m, float y_m) {
    return Point2f{at.x_m + c * x_m - s * y_m, at.y_m + s * x_m + c * y_m};
  };
  map.begin_scan();
  const auto each = [&](auto&& use) {
    for (std::size_t k = 0; k < sweep.points.size(); ++k) {
      const float x_m = sweep.points.x_m[k];
      const float y_m = sweep.points.y_m[k];
      if (std::hypot(x_m, y_m) <= config.max_insert_range_m) { use(place(x_m, y_m)); }
    }
  };
  const Point2f lidar = place(sweep.lidar_at_last_m.x_m, sweep.lidar_at_last_m.y_m);
  each([&](const Point2f& p) { map.add_hit(p); });
  each([&](const Point2f& p) { map.add_ray(lidar, p, config.ray_stop_cells); });
  map.repair(map.stale_tiles());
}

std::unique_ptr<ScanMatcher> make_scan_matcher(MatcherKind kind, const LocaliserConfig& config,
                                               RollingMapCore& map) {
  using Gn = GaussNewtonMatcher<DistanceFieldView>;
  using Lm = LevenbergMarquardtMatcher<DistanceFieldView>;
  switch (kind) {
    case MatcherKind::gn: return std::make_unique<FieldMatcher<Gn>>(Gn{config.fine}, config, map);
    case MatcherKind::lm:
      return std::make_unique<FieldMatcher<Lm>>(
          Lm{LevenbergMarquardtConfig{.residual = config.fine}}, config, map);
    case MatcherKind::correlative: return std::make_unique<SearchMatcher>(config, map);
    case MatcherKind::ndt: return make_ndt_matcher(config.noise.weight);
    case MatcherKind::plicp: break;
  }
  return make_plicp_matcher(config.noise.weight);
}

}  // namespace picolo::tool
