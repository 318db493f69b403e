// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "arc.hpp"

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

Arc arc_of(double theta_rad) {
  const double t = theta_rad;
  const double t2 = t * t;
  if (t2 < 9e-4) {
    return {1.0 - t2 / 6.0 * (1.0 - t2 / 20.0 * (1.0 - t2 / 42.0)),
            t / 2.0 * (1.0 - t2 / 12.0 * (1.0 - t2 / 30.0 * (1.0 - t2 / 56.0))),
            -t / 3.0 * (1.0 - t2 / 10.0 * (1.0 - t2 / 28.0)),
            0.5 - t2 / 8.0 * (1.0 - t2 / 18.0 * (1.0 - t2 / 40.0)),
            -1.0 / 3.0 + t2 / 10.0 * (1.0 - t2 * (5.0 / 84.0)),
            -t / 4.0 * (1.0 - t2 / 9.0)};
  }
  const SinCos<double> sc = sin_cos(t);
  const double along = sc.sine / t;
  const double across = (1.0 - sc.cosine) / t;
  const double d_along = (sc.cosine - along) / t;
  const double d_across = (sc.sine - across) / t;
  return {along,
          across,
          d_along,
          d_across,
          (-sc.sine - 2.0 * d_along) / t,
          (sc.cosine - 2.0 * d_across) / t};
}

}  // namespace picolo::inline v0
