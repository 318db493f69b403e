// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The first 64 samples of the streaming calibration: a first noise level, and gains to begin with.

#include <algorithm>

#include "joint_turns.hpp"
#include "picolo/calibration/joint_streaming.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

double turn_error(const MotionSample& sample, const RotationGain& gain) {
  const Turns turn = turns_of(sample);
  return magnitude(sample.lidar_motion.theta_rad - (gain.j21 * turn.left + gain.j22 * turn.right));
}

}  // namespace

/// Five rounds of: the gains of samples whose residual is below four medians, the residuals from
/// them, their median.
void JointStreaming::noise_slice() {
  if (next_ < kWarmUp) {
    add_turns(round_ == 0 ? 1e9 : 4.0 * kMedianToSigma * first_median_ + 1e-6);
  } else if (next_ < 2 * kWarmUp) {
    measure_turns();
  } else {
    close_noise_round();
  }
}

void JointStreaming::add_turns(double limit) {
  if (next_ == 0) { turns_ = {}; }
  for (const std::size_t end = next_ + kTurnsPerSlice; next_ < end; ++next_) {
    const MotionSample& sample = waiting_[next_];
    if (turn_error(sample, reference_) > limit) { continue; }
    const Turns turn = turns_of(sample);
    const double theta = sample.lidar_motion.theta_rad;
    turns_.ll += turn.left * turn.left;
    turns_.lr += turn.left * turn.right;
    turns_.rr += turn.right * turn.right;
    turns_.lt += turn.left * theta;
    turns_.rt += turn.right * theta;
  }
  if (next_ < kWarmUp) { return; }
  // A small ridge picks the smallest gains when the wheels have not varied yet (which makes the
  // wheels of a turn on the spot equal: the best guess there is).
  const TurnSums& s = turns_;
  const double ridge = 1e-3 * (s.ll + s.rr);
  const double determinant = (s.ll + ridge) * (s.rr + ridge) - s.lr * s.lr;
  reference_ = determinant > 0.0 ? RotationGain{((s.rr + ridge) * s.lt - s.lr * s.rt) / determinant,
                                                ((s.ll + ridge) * s.rt - s.lr * s.lt) / determinant}
                                 : RotationGain{};
}

void JointStreaming::measure_turns() {
  for (const std::size_t end = next_ + kTurnsPerSlice; next_ < end; ++next_) {
    work_[next_ - kWarmUp] = turn_error(waiting_[next_ - kWarmUp], reference_);
  }
}

void JointStreaming::close_noise_round() {
  std::sort(work_.begin(), work_.end());
  first_median_ = work_[kWarmUp / 2];
  next_ = 0;
  ++round_;
  if (round_ < kNoiseRounds) { return; }
  first_gain_ = reference_;
  scale_rotation_rad_ = std::max(1e-6, kMedianToSigma * first_median_);
  stage_ = Stage::keep;
}

void JointStreaming::keep_turns() {
  if (next_ < kWarmUp) {
    // While those that waited pass the gate, it stands where all of them together put it. Until
    // then nothing has passed it, and `check_` is free.
    for (const std::size_t end = next_ + kChecksPerSlice; next_ < end; ++next_) {
      if (turn_error(waiting_[next_], reference_) <= 4.0 * scale_rotation_rad_) {
        check_.add(waiting_[next_]);
      }
    }
    return;
  }
  follow_gain(check_);
  check_ = MotionCheck{};
  limit_ = 1e9;
  round_ = 0;
  next_ = 0;
  predictor_.refresh();
  stage_ = Stage::predictor;
}

void JointStreaming::predictor_slice() {
  if (next_ == kWarmUp) {
    close_predictor_round();
    return;
  }
  if (next_ == 0) { next_predictor_.reset(); }
  const std::size_t end = std::min(kWarmUp, next_ + kSamplesPerSlice);
  for (; next_ < end; ++next_) {
    const auto judged = predictor_.judge(gain_, waiting_[next_]);
    work_[next_] = hypotenuse(judged.x_m, judged.y_m);
    if (work_[next_] <= limit_) { next_predictor_.add(gain_, waiting_[next_]); }
  }
}

void JointStreaming::close_predictor_round() {
  predictor_ = next_predictor_;
  std::sort(work_.begin(), work_.end());
  limit_ = 3.5 * work_[kWarmUp / 2];
  predictor_.refresh();
  next_ = 0;
  ++round_;
  if (round_ < kPredictorRounds) { return; }
  scale_translation_m_ = std::max(1e-6, work_[kWarmUp / 2] / kMedianToRayleigh);
  stage_ = Stage::consume;
}

}  // namespace picolo::inline v0
