// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/motion_check.hpp"

#include <algorithm>

#include "picolo/core/arithmetic.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
void SwingMeter::add(double change) {
  if (direction_ == 0) {  // no swing yet: watch both ways
    rise_ = std::max(rise_ + change, 0.0);
    fall_ = std::max(fall_ - change, 0.0);
    if (rise_ > threshold_) {
      direction_ = 1;
      positive_ += rise_;
    } else if (fall_ > threshold_) {
      direction_ = -1;
      negative_ += fall_;
    }
    return;
  }
  // How far the value has come back from the extreme of the present swing.
  back_ -= direction_ > 0 ? change : -change;
  double& present = direction_ > 0 ? positive_ : negative_;
  double& other = direction_ > 0 ? negative_ : positive_;
  if (back_ < 0.0) {
    present -= back_;
    back_ = 0.0;
  } else if (back_ > threshold_) {
    other += back_;
    back_ = 0.0;
    direction_ = -direction_;
  }
}

double SwingMeter::positive() const {
  return positive_;
}
double SwingMeter::negative() const {
  return negative_;
}

void MotionCheck::add(const MotionSample& sample) {
  const double left = sample.duration_s * sample.left_radps;
  const double right = sample.duration_s * sample.right_radps;
  const double theta = sample.lidar_motion.theta_rad;
  ++samples_;
  left_rad_ += magnitude(left);
  right_rad_ += magnitude(right);
  ll_ += left * left;
  lr_ += left * right;
  rr_ += right * right;
  lt_ += left * theta;
  rt_ += right * theta;
  tt_ += theta * theta;
  lidar_travel_m_ += hypotenuse(sample.lidar_motion.x_m, sample.lidar_motion.y_m);
  heading_.add(theta);
  wheels_.add(0.5 * (left + right));
}

double MotionCheck::wheel_travel_rad() const {
  return wheels_.positive() + wheels_.negative();
}

double MotionCheck::arc_spread() const {
  const double uu = ll_ + 2.0 * lr_ + rr_;  // u = l + r, w = r - l
  const double ww = ll_ - 2.0 * lr_ + rr_;
  const double uw = rr_ - ll_;
  return uu > 0.0 && ww > 0.0 ? 1.0 - uw * uw / (uu * ww) : 0.0;
}

double MotionCheck::speed_share() const {
  const double uu = ll_ + 2.0 * lr_ + rr_;
  const double ww = ll_ - 2.0 * lr_ + rr_;
  return uu + ww > 0.0 ? uu / (uu + ww) : 0.0;
}

Status MotionCheck::rotation_gain(RotationGain& gain) const {
  const double determinant = ll_ * rr_ - lr_ * lr_;
  if (!(determinant > 1e-12 * ll_ * rr_)) { return Status::degenerate; }
  gain.j21 = (rr_ * lt_ - lr_ * rt_) / determinant;
  gain.j22 = (ll_ * rt_ - lr_ * lt_) / determinant;
  return Status::ok;
}

void MotionCheck::gain_with_prior(const RotationGain& prior, double information, RotationGain& gain,
                                  std::array<double, 4>& covariance) const {
  const double ll = ll_ + information;
  const double rr = rr_ + information;
  const double lt = lt_ + information * prior.j21;
  const double rt = rt_ + information * prior.j22;
  const double determinant = ll * rr - lr_ * lr_;
  gain = {(rr * lt - lr_ * rt) / determinant, (ll * rt - lr_ * lt) / determinant};
  covariance = {rr / determinant, -lr_ / determinant, -lr_ / determinant, ll / determinant};
}

double MotionCheck::explained_rotation() const {
  RotationGain gain;
  if (!is_ok(rotation_gain(gain)) || !(tt_ > 0.0)) { return 0.0; }
  return (gain.j21 * lt_ + gain.j22 * rt_) / tt_;
}

Refusal MotionCheck::judge_encoders() const {
  if (left_rad_ < 0.02 * right_rad_) {
    return {RefusalReason::encoder_disconnected, Parameter::wheel_radius_left};
  }
  if (right_rad_ < 0.02 * left_rad_) {
    return {RefusalReason::encoder_disconnected, Parameter::wheel_radius_right};
  }
  RotationGain gain;
  if (!is_ok(rotation_gain(gain)) || explained_rotation() < 0.5 || arc_spread() < 0.01 ||
      speed_share() < 1e-3 || speed_share() > 0.999) {
    return {};
  }
  // A radius is positive: a sign that is clearly wrong shows how the encoder is connected.
  const double scale = std::max(magnitude(gain.j21), magnitude(gain.j22));
  const bool left_wrong = gain.j21 > 0.2 * scale;
  const bool right_wrong = gain.j22 < -0.2 * scale;
  if (left_wrong && right_wrong) {
    return {RefusalReason::encoder_swapped, Parameter::wheel_radius_left};
  }
  if (left_wrong) { return {RefusalReason::encoder_reversed, Parameter::wheel_radius_left}; }
  if (right_wrong) { return {RefusalReason::encoder_reversed, Parameter::wheel_radius_right}; }
  return {};
}

Refusal MotionCheck::judge(const MotionNeeds& needs) const {
  const double turned = turned_left_rad() + turned_right_rad();
  const bool wheels_stand = left_rad_ + right_rad_ < 1.0;
  if (wheels_stand && turned < needs.min_turn_rad) {
    return {samples_ == 0 ? RefusalReason::too_little_data : RefusalReason::standing_still,
            Parameter::wheel_radius_left};
  }
  if (const Refusal encoders = judge_encoders()) { return encoders; }
  if (samples_ < needs.samples) {
    return {RefusalReason::too_little_data, Parameter::wheel_radius_left};
  }
  // Unequal tyres bend a straight drive by a few percent: that is no turn yet.
  const bool hardly_bent = speed_share() > 0.999 && turned < 2.0 * needs.turn_each_way_rad;
  if (turned < needs.min_turn_rad || hardly_bent) {
    return {RefusalReason::straight_only, Parameter::track_width};
  }
  if (wheel_travel_rad() < 0.25 * needs.wheel_travel_rad || speed_share() < 1e-3) {
    return {RefusalReason::pure_rotation, Parameter::wheel_radius_left};
  }
  if (arc_spread() < needs.min_arc_spread) {
    return {RefusalReason::constant_arc, Parameter::track_width};
  }
  const double more = std::max(turned_left_rad(), turned_right_rad());
  const double less = std::min(turned_left_rad(), turned_right_rad());
  if (needs.both_directions && more >= needs.turn_each_way_rad && less < needs.min_turn_rad) {
    return {RefusalReason::one_turn_direction, Parameter::track_width};
  }
  if ((needs.both_directions ? less : more) < needs.turn_each_way_rad) {
    return {RefusalReason::too_little_data, Parameter::track_width};
  }
  if (wheel_travel_rad() < needs.wheel_travel_rad) {
    return {RefusalReason::too_little_data, Parameter::wheel_radius_left};
  }
  return {};
}

}  // namespace picolo::inline v0
