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

/// J21, J22 of samples whose residual is at most `limit` from the gain so far; a small ridge picks
/// the smallest gains when the wheels have not varied yet (which makes the wheels of a turn on the
/// spot equal: the best guess there is).
RotationGain ridge_gain(std::span<const MotionSample> samples, const RotationGain& before,
                        double limit) {
  double ll = 0.0, lr = 0.0, rr = 0.0, lt = 0.0, rt = 0.0;
  for (const MotionSample& sample : samples) {
    const Turns turn = turns_of(sample);
    const double theta = sample.lidar_motion.theta_rad;
    if (magnitude(theta - (before.j21 * turn.left + before.j22 * turn.right)) > limit) { continue; }
    ll += turn.left * turn.left;
    lr += turn.left * turn.right;
    rr += turn.right * turn.right;
    lt += turn.left * theta;
    rt += turn.right * theta;
  }
  const double ridge = 1e-3 * (ll + rr);
  const double determinant = (ll + ridge) * (rr + ridge) - lr * lr;
  if (!(determinant > 0.0)) { return {}; }
  return {((rr + ridge) * lt - lr * rt) / determinant, ((ll + ridge) * rt - lr * lt) / determinant};
}

double median_residual(std::span<const MotionSample> samples, const RotationGain& gain,
                       std::span<double> work) {
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Turns turn = turns_of(samples[k]);
    work[k] = magnitude(samples[k].lidar_motion.theta_rad -
                        (gain.j21 * turn.left + gain.j22 * turn.right));
  }
  std::sort(work.begin(), work.end());
  return work[work.size() / 2];
}

}  // namespace

void JointStreaming::noise_round() {
  const double limit = round_ == 0 ? 1e9 : 4.0 * kMedianToSigma * first_median_ + 1e-6;
  reference_ = ridge_gain(waiting(), reference_, limit);
  first_median_ = median_residual(waiting(), reference_, work_);
  ++round_;
  if (round_ < kNoiseRounds) { return; }
  first_gain_ = reference_;
  scale_rotation_rad_ = std::max(1e-6, kMedianToSigma * first_median_);
  stage_ = Stage::keep;
}

void JointStreaming::keep_turns() {
  // While those that waited pass the gate, it stands where all of them together put it.
  MotionCheck kept;
  for (const MotionSample& sample : waiting()) {
    const Turns turn = turns_of(sample);
    const double error =
        sample.lidar_motion.theta_rad - (reference_.j21 * turn.left + reference_.j22 * turn.right);
    if (magnitude(error) <= 4.0 * scale_rotation_rad_) { kept.add(sample); }
  }
  follow_gain(kept);
  limit_ = 1e9;
  round_ = 0;
  next_ = 0;
  predictor_.refresh();
  stage_ = Stage::predictor;
}

void JointStreaming::predictor_slice() {
  if (next_ == 0) { next_predictor_.reset(); }
  const std::size_t end = std::min(kWarmUp, next_ + kSamplesPerSlice);
  for (; next_ < end; ++next_) {
    const auto judged = predictor_.judge(gain_, waiting_[next_]);
    work_[next_] = hypotenuse(judged.x_m, judged.y_m);
    if (work_[next_] <= limit_) { next_predictor_.add(gain_, waiting_[next_]); }
  }
  if (next_ == kWarmUp) { close_predictor_round(); }
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
