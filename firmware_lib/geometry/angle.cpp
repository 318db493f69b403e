// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/geometry/angle.hpp"

#include "picolo/core/convert.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

float wrap_angle(float angle_rad) {
  constexpr float kPi = 3.14159265358979324F;
  if (angle_rad >= -kPi && angle_rad <= kPi) { return angle_rad; }
  const auto turns =
      static_cast<float>(round_to_i32(angle_rad * 0.159154943091895336F, -(1 << 20), 1 << 20));
  const float wrapped = (angle_rad - turns * 6.28125F) - turns * 1.93530717958648e-3F;
  return wrapped > kPi ? kPi : (wrapped < -kPi ? -kPi : wrapped);
}

double wrap_angle(double angle_rad) {
  constexpr double kPi = 3.14159265358979324;
  if (angle_rad >= -kPi && angle_rad <= kPi) { return angle_rad; }
  const auto turns =
      static_cast<double>(round_to_i64(angle_rad * 0.159154943091895336, -(1LL << 40), 1LL << 40));
  const double wrapped = (angle_rad - turns * 0x1.921FB544p2) - turns * 0x1.0B4611A62633Ap-32;
  return wrapped > kPi ? kPi : (wrapped < -kPi ? -kPi : wrapped);
}

}  // namespace picolo::inline v0
