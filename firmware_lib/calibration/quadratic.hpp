// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Polynomials of degree two in the deviation (a, b) of J21, J22 from a reference: sums over
/// samples stay exact functions of the gains to second order, so the second stage of a calibration
/// needs no second pass.
#pragma once

#include <array>

#include "picolo/calibration/wheel_model.hpp"

namespace picolo::inline v0 {

/// Coefficients of 1, a, b, a^2, ab, b^2.
using Quadratic = std::array<double, 6>;

[[nodiscard]] Quadratic linear_form(double constant, double a, double b);
[[nodiscard]] Quadratic operator+(const Quadratic& p, const Quadratic& q);
[[nodiscard]] Quadratic operator-(const Quadratic& p, const Quadratic& q);
[[nodiscard]] Quadratic operator*(double factor, const Quadratic& p);
/// Product without the terms of degree three and four.
[[nodiscard]] Quadratic operator*(const Quadratic& p, const Quadratic& q);
void add_to(Quadratic& sum, const Quadratic& p);
/// f(p) of a function with value, first and second derivative at the constant term of p.
[[nodiscard]] Quadratic chain(const Quadratic& p, double value, double first, double second);
[[nodiscard]] double evaluate(const Quadratic& p, double a, double b);
/// The same polynomial around a reference that is (a, b) away.
[[nodiscard]] Quadratic shifted(const Quadratic& p, double a, double b);

}  // namespace picolo::inline v0
