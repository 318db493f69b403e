// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Simultaneous calibration in one pass and constant memory: what runs on the target while the
/// vehicle drives.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

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
/// level. State: see `sizeof`, under 8 KiB, whatever the number of samples. Context: one at a time.
///
/// In a cycle: `offer` each sample, then `step` as long as there is time. Cost of `offer`: a copy;
/// of a `step`: at most about 1200 floating-point operations.
class JointStreaming {
 public:
  explicit JointStreaming(const JointStreamingConfig& config = {}) : config_(config) {}

  /// Keeps the sample for `step`. `invalid_argument`: a number that is not finite, or no duration;
  /// not counted. `full`: more than kQueue wait beyond the first 64; dropped and not counted.
  Status offer(const MotionSample& sample);
  /// One slice of work. False when there is nothing to do.
  bool step();
  /// Forgets every sample.
  void reset();
  /// `offer`, and all the steps that follow from it.
  Status add(const MotionSample& sample);

  /// The solution now, of what the steps have come to. `degenerate` with a refusal when the drive
  /// does not suffice yet; `drive` holds what could be computed. `covariance` and
  /// `inlier_covariance` are the same: noise of the samples behind the gate. Cost: a Jacobi SVD of
  /// 6x6 for the condition number, about 10 000 operations; without it some 1500.
  Status solve(JointReport& report, bool with_condition = true) const;
  /// The same in three slices: the solution; where that is `ok`, the information about it, left in
  /// `covariance`; its deviations.
  Status solve_drive(JointReport& report) const;
  void solve_information(JointReport& report) const;
  Status solve_deviations(JointReport& report, bool with_condition) const;
  [[nodiscard]] const MotionCheck& check() const { return check_; }
  [[nodiscard]] std::uint64_t samples() const { return samples_; }
  [[nodiscard]] std::uint64_t rejected() const { return rejected_; }

  static constexpr std::size_t kQueue = 15;

 private:
  static constexpr std::size_t kWarmUp = 64;
  static constexpr std::size_t kNoiseRounds = 5;
  static constexpr std::size_t kPredictorRounds = 5;
  static constexpr std::size_t kMoments = 15;  // lower triangle of the 5x5 second stage
  static constexpr std::size_t kTurnsPerSlice = 32;
  static constexpr std::size_t kChecksPerSlice = 16;
  static constexpr std::size_t kSamplesPerSlice = 1;
  /// gather until 64 wait; rotation noise; which turns to keep; displacement noise; then one by
  /// one.
  enum class Stage : std::uint8_t { gather, noise, keep, predictor, consume };
  /// What becomes of one sample in the last stage, a slice each.
  enum class Part : std::uint8_t { gate, moments, more_moments, information };
  /// Normal equations of J21, J22.
  struct TurnSums {
    double ll = 0.0, lr = 0.0, rr = 0.0;
    double lt = 0.0, rt = 0.0;
  };

  void noise_slice();
  void add_turns(double limit);
  void measure_turns();
  void close_noise_round();
  void keep_turns();
  void predictor_slice();
  void close_predictor_round();
  void consume_slice();
  void release();
  [[nodiscard]] std::span<const MotionSample> waiting() const {
    return std::span<const MotionSample>{waiting_}.first(std::min(held_, kWarmUp));
  }
  void follow_gain(const MotionCheck& seen);
  void refresh_gate();
  void refresh_solution();
  [[nodiscard]] bool passes(const MotionSample& sample);
  [[nodiscard]] Pose2d noise() const;
  [[nodiscard]] Status current(RotationGain& gain, DriveParameters& drive) const;
  void add_moments(const MotionSample& sample, std::size_t from, std::size_t to);
  void add_to_information(const MotionSample& sample);

  JointStreamingConfig config_;
  MotionCheck check_{};   // of the samples behind the gate
  MotionCheck waited_{};  // of the first 64
  TurnSums turns_{};      // of a round among them
  std::array<std::array<double, 6>, kMoments> moments_{};
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
  // Mean squares of what passed the gate: the noise that is reported; a running median wanders.
  double squares_rotation_ = 0.0;
  double squares_translation_ = 0.0;
  std::uint64_t gated_rotation_ = 0;
  std::uint64_t gated_translation_ = 0;
  std::uint64_t samples_ = 0;
  std::uint64_t rejected_ = 0;
  Stage stage_ = Stage::gather;
  Part part_ = Part::gate;
  std::size_t round_ = 0;
  std::size_t next_ = 0;   // of the present round
  int refreshes_due_ = 0;  // two slices: what the gate predicts by, then the solution
  std::uint64_t consumed_ = 0;
  double first_median_ = 0.0;
  double limit_ = 0.0;
  DisplacementPredictor next_predictor_{};
  std::array<double, kWarmUp> work_{};
  std::array<MotionSample, kWarmUp + kQueue> waiting_{};  // a ring from the 65th on
  std::size_t oldest_ = 0;
  std::size_t held_ = 0;
};

}  // namespace picolo::inline v0
