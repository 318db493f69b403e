// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Matchers that keep a map, or a scan, of their own.

#include <algorithm>
#include <cmath>
#include <vector>

#include "picolo/map/ndt_map.hpp"
#include "picolo/matching/ndt.hpp"
#include "picolo/matching/plicp.hpp"
#include "scan_matcher.hpp"

namespace picolo::tool {
namespace {

constexpr int kNdtSide = 256;
constexpr std::size_t kMaxPoints = SiteProfile::kReturns;

/// Cells of 1 m find the pose from afar and with few points, cells of 0.5 m tell it more exactly.
class NdtScanMatcher final : public ScanMatcher {
 public:
  explicit NdtScanMatcher(float prior_weight) : prior_weight_{prior_weight} {}

  void follow(const Pose2d& map_T_base) override {
    for (Map* map : {&wide_, &fine_}) {
      if (empty_) { map->core().reset(map_T_base.x_m, map_T_base.y_m); }
      map->core().follow(map_T_base.x_m, map_T_base.y_m);
    }
  }
  ScanMatch match(const UndistortedSweep& sweep, const Pose2d& guess,
                  const GuessSigma& sigma) override {
    ScanMatch best = match_with(wide_, sweep, guess, guess, sigma);
    const Pose2d start = is_pose(best.report.outcome) ? best.map_T_base : guess;
    const ScanMatch fine = match_with(fine_, sweep, guess, start, sigma);
    return is_pose(fine.report.outcome) ? fine : best;
  }
  void add(const UndistortedSweep& sweep, const Pose2d& map_T_base) override {
    for (Map* map : {&wide_, &fine_}) {
      const Pose2f at = to_window(map->core().window(), map_T_base);
      const float c = std::cos(at.theta_rad);
      const float s = std::sin(at.theta_rad);
      for (std::size_t k = 0; k < sweep.points.size(); ++k) {
        const float x_m = sweep.points.x_m[k];
        const float y_m = sweep.points.y_m[k];
        map->core().add({at.x_m + c * x_m - s * y_m, at.y_m + s * x_m + c * y_m});
      }
    }
    empty_ = false;
  }

 private:
  using Map = NdtMap<kNdtSide, kNdtSide>;

  ScanMatch match_with(Map& map, const UndistortedSweep& sweep, const Pose2d& guess,
                       const Pose2d& start, const GuessSigma& sigma) {
    const GridWindow& window = map.core().window();
    const MatchRequest request{.points = sweep.points,
                               .start = to_window(window, start),
                               .prior = prior_of(to_window(window, guess), sigma, prior_weight_)};
    const MatchReport report = matcher_.match(map.core().view(), request);
    return {report, to_map(window, report.pose), report.covariance};
  }

  Map wide_{NdtMapConfig{.cell_m = 1.0F, .min_points = 3}};
  Map fine_{NdtMapConfig{.cell_m = 0.5F}};
  NdtMatcher matcher_;
  float prior_weight_;
  bool empty_ = true;
};

/// Scan to scan against a key scan, which is replaced when the vehicle has left its surroundings.
class PlIcpScanMatcher final : public ScanMatcher {
 public:
  explicit PlIcpScanMatcher(float prior_weight) : prior_weight_{prior_weight} {
    for (std::vector<float>* values : {&key_x_m_, &key_y_m_, &x_m_, &y_m_}) {
      values->reserve(kMaxPoints);
    }
  }
  void follow(const Pose2d& /*map_T_base*/) override {}
  ScanMatch match(const UndistortedSweep& sweep, const Pose2d& guess,
                  const GuessSigma& sigma) override {
    // Frames with the axes of base and the lidar as origin: partners are looked for by bearing.
    shift(sweep, x_m_, y_m_);
    const Pose2d base_T_sensor{sweep.lidar_at_last_m.x_m, sweep.lidar_at_last_m.y_m, 0.0};
    const Pose2d map_T_reference = map_T_key_ * base_T_key_sensor_;
    MatchRequest request{.points = {.x_m = x_m_, .y_m = y_m_},
                         .start = to_f32(between(map_T_reference, guess * base_T_sensor))};
    request.prior = prior_of(request.start, sigma, prior_weight_);
    const MatchReport report = matcher_.match({.x_m = key_x_m_, .y_m = key_y_m_}, request);
    const Pose2d map_T_base = map_T_reference * to_f64(report.pose) * inverse(base_T_sensor);
    return {report, map_T_base, turned(report.covariance, map_T_reference.theta_rad)};
  }
  void add(const UndistortedSweep& sweep, const Pose2d& map_T_base) override {
    constexpr double kKeep_m = 0.3;
    constexpr double kKeep_rad = 0.2;
    const Pose2d moved = between(map_T_key_, map_T_base);
    const bool near =
        std::hypot(moved.x_m, moved.y_m) < kKeep_m && std::abs(moved.theta_rad) < kKeep_rad;
    if (!key_x_m_.empty() && near) { return; }
    map_T_key_ = map_T_base;
    base_T_key_sensor_ = {sweep.lidar_at_last_m.x_m, sweep.lidar_at_last_m.y_m, 0.0};
    shift(sweep, key_x_m_, key_y_m_);
  }

 private:
  static void shift(const UndistortedSweep& sweep, std::vector<float>& x_m,
                    std::vector<float>& y_m) {
    const std::size_t count = std::min(sweep.points.size(), kMaxPoints);
    x_m.resize(count);
    y_m.resize(count);
    for (std::size_t k = 0; k < count; ++k) {
      x_m[k] = sweep.points.x_m[k] - sweep.lidar_at_last_m.x_m;
      y_m[k] = sweep.points.y_m[k] - sweep.lidar_at_last_m.y_m;
    }
  }
  /// From the axes of the key scan to those of the map: G C G'.
  static Matrix3f turned(const Matrix3f& covariance, double angle_rad) {
    const auto c = static_cast<float>(std::cos(angle_rad));
    const auto s = static_cast<float>(std::sin(angle_rad));
    const float turn[3][3] = {{c, -s, 0.0F}, {s, c, 0.0F}, {0.0F, 0.0F, 1.0F}};
    Matrix3f result{};
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        float sum = 0.0F;
        for (std::size_t k = 0; k < 3; ++k) {
          for (std::size_t l = 0; l < 3; ++l) { sum += turn[i][k] * covariance(k, l) * turn[j][l]; }
        }
        result(i, j) = sum;
      }
    }
    return result;
  }

  PlIcpMatcher<kMaxPoints> matcher_;
  float prior_weight_;
  std::vector<float> key_x_m_;
  std::vector<float> key_y_m_;
  std::vector<float> x_m_;
  std::vector<float> y_m_;
  Pose2d map_T_key_{};
  Pose2d base_T_key_sensor_{};
};

}  // namespace

std::unique_ptr<ScanMatcher> make_ndt_matcher(float prior_weight) {
  return std::make_unique<NdtScanMatcher>(prior_weight);
}

std::unique_ptr<ScanMatcher> make_plicp_matcher(float prior_weight) {
  return std::make_unique<PlIcpScanMatcher>(prior_weight);
}

}  // namespace picolo::tool
