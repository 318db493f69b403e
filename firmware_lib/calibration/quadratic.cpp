// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "quadratic.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

Quadratic linear_form(double constant, double a, double b) {
  return {constant, a, b, 0.0, 0.0, 0.0};
}

Quadratic operator+(const Quadratic& p, const Quadratic& q) {
  Quadratic result = p;
  add_to(result, q);
  return result;
}

Quadratic operator-(const Quadratic& p, const Quadratic& q) {
  return p + (-1.0) * q;
}

Quadratic operator*(double factor, const Quadratic& p) {
  Quadratic result = p;
  for (double& c : result) { c *= factor; }
  return result;
}

Quadratic operator*(const Quadratic& p, const Quadratic& q) {
  return {p[0] * q[0],
          p[0] * q[1] + p[1] * q[0],
          p[0] * q[2] + p[2] * q[0],
          (p[0] * q[3] + p[3] * q[0]) + p[1] * q[1],
          (p[0] * q[4] + p[4] * q[0]) + (p[1] * q[2] + p[2] * q[1]),
          (p[0] * q[5] + p[5] * q[0]) + p[2] * q[2]};
}

void add_to(Quadratic& sum, const Quadratic& p) {
  for (std::size_t k = 0; k < 6; ++k) { sum[k] += p[k]; }
}

Quadratic chain(const Quadratic& p, double value, double first, double second) {
  Quadratic step = p;
  step[0] = 0.0;
  Quadratic result = first * step + (0.5 * second) * (step * step);
  result[0] = value;
  return result;
}

double evaluate(const Quadratic& p, double a, double b) {
  return p[0] + (p[1] * a + p[2] * b) + (p[3] * a * a + p[4] * a * b + p[5] * b * b);
}

Quadratic shifted(const Quadratic& p, double a, double b) {
  return {evaluate(p, a, b),
          p[1] + 2.0 * p[3] * a + p[4] * b,
          p[2] + p[4] * a + 2.0 * p[5] * b,
          p[3],
          p[4],
          p[5]};
}

}  // namespace picolo::inline v0
