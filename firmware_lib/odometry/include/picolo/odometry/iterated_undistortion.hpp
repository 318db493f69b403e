// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Undistortion by IMU, corrected by matching: undistort, match, take the match as truth, spread
/// what is left of the motion linearly over the sweep, and again, until it converges.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/status.hpp"
#include "picolo/map/likelihood_field.hpp"
#include "picolo/matching/gauss_newton.hpp"
#include "picolo/undistort/pose_buffer.hpp"
#include "picolo/undistort/undistorter.hpp"

namespace picolo::inline v0 {

struct IteratedUndistortionConfig {
  int max_rounds = 8;             ///< of undistortion and match; 1: the IMU alone
  float converged_m = 2e-3F;      ///< stop when a round changes the correction by less than both
  float converged_rad = 3.5e-4F;  ///< 0.02 deg
  float max_correction_m = 0.5F;  ///< beyond, the match is not believed
  float max_correction_rad = 0.3F;
  GaussNewtonConfig match{};
  [[nodiscard]] constexpr bool valid() const {
    return max_rounds > 0 && converged_m > 0.0F && converged_rad > 0.0F &&
           max_correction_m > 0.0F && max_correction_rad > 0.0F && match.valid();
  }
};
static_assert(IteratedUndistortionConfig{}.valid());

struct IteratedUndistortionReport {
  MatchReport match{};  ///< of the last round
  Pose2f correction{};  ///< E: motion over the sweep = IMU motion * E
  int rounds = 0;
  bool converged = false;  ///< the last round changed nothing any more
  bool believed = true;    ///< false: a match failed or asked for too much; the points are
                           ///< those of the IMU alone
};

/// A pose that is taken as known: of the last match, or of the sweep's first return.
struct MatchAnchor {
  Timestamp stamp{};
  Pose2f window_T_base{};
};

/// anchor_T_base(t) = T_imu(t) * (share of E), the share being 1 at the middle of the sweep and
/// growing linearly from 0 at the anchor; E follows from the match, whose pose stands for the
/// sweep's middle. The middle, because there an error of E moves as many points forward as back and
/// the match does not feel it; a match that stood for the sweep's end would hand half of the error
/// to the next sweep, with the sign turned, for ever. Resumable: `begin`, then `step` until `ok`.
/// Context: cycle only.
class IteratedUndistortionCore {
 public:
  IteratedUndistortionCore(const IteratedUndistortionConfig& config, UndistorterCore& undistorter,
                           PoseBufferCore& corrected)
      : config_(config), undistorter_(undistorter), corrected_(corrected), matcher_(config.match) {}

  /// `imu_poses`: the motion as the IMU has it, from the anchor to the sweep's end; it must keep
  /// that time until the last step. Reference and frame of `undistort` are overridden: the sweep's
  /// middle, base. `not_ready`: the poses do not reach the sweep's end yet; `out_of_range`: they
  /// begin after the anchor (take the sweep's first return as the anchor then);
  /// `invalid_argument`: configuration, or an anchor that is not before the sweep's middle; others
  /// as UndistorterCore::begin.
  Status begin(const UndistortConfig& undistort, const Sweep& sweep,
               const PoseBufferCore& imu_poses, const DistanceFieldView& field,
               const MatchAnchor& anchor);
  /// Up to `max_returns` returns, or one iteration of a match. `not_ready`: call again; `ok`: the
  /// result is final.
  Status step(std::size_t max_returns);
  [[nodiscard]] const IteratedUndistortionReport& report() const { return report_; }
  /// After `ok`; the points in base at the sweep's middle. `odom_T_base` is anchor_T_base(middle).
  [[nodiscard]] const UndistortedSweep& sweep() const { return undistorter_.result(); }
  /// After `ok`: the anchor for the next sweep.
  [[nodiscard]] MatchAnchor anchor() const;

  static constexpr std::size_t kPoses = 64;

 private:
  enum class Phase : std::uint8_t { idle, undistorting, matching, last_undistorting };

  Status start_round(Phase phase);
  void conclude_round();

  IteratedUndistortionConfig config_;
  UndistorterCore& undistorter_;
  PoseBufferCore& corrected_;
  GaussNewtonMatcher<DistanceFieldView> matcher_;
  UndistortConfig undistort_{};
  Sweep sweep_{};
  const PoseBufferCore* imu_poses_ = nullptr;
  DistanceFieldView field_{};
  MatchAnchor anchor_{};
  Timestamp middle_{};
  Pose2d anchor_T_imu_middle_{};
  IteratedUndistortionReport report_{};
  Phase phase_ = Phase::idle;
};

/// Storage: 8 bytes a return and 2 KiB.
template <std::size_t Returns>
class IteratedUndistortion {
 public:
  explicit IteratedUndistortion(const IteratedUndistortionConfig& config = {})
      : corrected_(poses_), undistorter_(x_m_, y_m_), core_(config, undistorter_, corrected_) {}
  IteratedUndistortion(const IteratedUndistortion&) = delete;
  IteratedUndistortion& operator=(const IteratedUndistortion&) = delete;
  ~IteratedUndistortion() = default;

  [[nodiscard]] IteratedUndistortionCore& core() { return core_; }

 private:
  std::array<StampedPose, IteratedUndistortionCore::kPoses> poses_{};
  std::array<float, Returns> x_m_{};
  std::array<float, Returns> y_m_{};
  PoseBufferCore corrected_;
  UndistorterCore undistorter_;
  IteratedUndistortionCore core_;
};

}  // namespace picolo::inline v0
