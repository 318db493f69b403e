// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Simultaneous calibration in one pass and constant memory: what runs on the target while the
/// vehicle drives.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/calibration/displacement_predictor.hpp"
#include "picolo/calibration/joint_batch.hpp"
#include "picolo/calibration/motion_check.hpp"
#include "picolo/calibration/parameter.hpp"
#include "picolo/calibration/wheel_model.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

struct JointStreamingConfig {
  MotionNeeds needs{};
  double max_relative_std = 0.005;  ///< of radii and track width; above: more data is needed
  double max_yaw_std_rad = 0.005;
  double max_position_std_m = 0.01;
  double gate_rotation = 10.83;     ///< chi-square, one degree of freedom, 0.1 %
  double gate_translation = 13.82;  ///< two degrees of freedom, 0.1 %
  [[nodiscard]] constexpr bool valid() const {
    return needs.valid() && max_relative_std > 0.0 && max_yaw_std_rad > 0.0 &&
           max_position_std_m > 0.0 && gate_rotation > 0.0 && gate_translation > 0.0;
  }
};

/// The rotation gains J21, J22 are least squares as they are; the second stage's moments are kept
/// as polynomials around a reference gain and evaluated where the gains come to lie. Each sample
/// passes a chi-square gate against the present solution; the noise behind the gate is the running
/// median of residuals, so a wrong start heals itself. The first 64 samples wait for a first noise
/// level. State: see `sizeof`, about 6 KiB, whatever the number of samples. Cost of `add`: one
/// sin_cos and some 400 multiplications, every fourth sample a 4x4 inverse; the 64th sample works
/// on all 64 that waited. Context: one at a time.
class JointStreaming {
 public:
  explicit JointStreaming(const JointStreamingConfig& config = {}) : config_(config) {}

  /// `invalid_argument`: a number that is not finite, or no duration; not counted.
  Status add(const MotionSample& sample);
  /// The solution now. `degenerate` with a refusal when the drive does not suffice yet; `drive`
  /// holds what could be computed. `covariance` and `inlier_covariance` are the same: noise of the
  /// samples behind the gate.
  Status solve(JointReport& report) const;
  [[nodiscard]] const MotionCheck& check() const { return check_; }
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::uint64_t rejected() const { return rejected_; }

 private:
  static constexpr std::size_t kWarmUp = 64;

  void warm_up();
  void consume(const MotionSample& sample);
  void follow_gain(const MotionCheck& seen);
  void refresh();
  [[nodiscard]] bool passes(const MotionSample& sample);
  [[nodiscard]] Status current(RotationGain& gain, DriveParameters& drive) const;
  void accumulate(const MotionSample& sample);

  JointStreamingConfig config_;
  MotionCheck check_{};                              // of the samples behind the gate
  std::array<std::array<double, 6>, 15> moments_{};  // lower triangle of the 5x5 second stage
  RotationGain reference_{};
  RotationGain first_gain_{};
  std::array<double, 36> information_translation_{};  // for unit noise
  std::array<double, 36> information_rotation_{};
  DriveParameters drive_{};  // refreshed every fourth sample
  RotationGain gain_{};
  std::array<double, 4> gain_covariance_{};  // for unit noise
  DisplacementPredictor predictor_{};
  bool solved_ = false;
  bool gains_known_ = false;  // for the present sample's turn
  double scale_rotation_rad_ = 0.0;
  double scale_translation_m_ = 0.0;
  std::uint64_t samples_ = 0;
  std::uint64_t rejected_ = 0;
  std::array<MotionSample, kWarmUp> waiting_{};
};

}  // namespace picolo::inline v0
