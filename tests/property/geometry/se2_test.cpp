// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The group laws of SE(2) and its maps, over random poses.

#include <cmath>

#include "picolo/geometry/angle.hpp"
#include "picolo/geometry/matrix3.hpp"
#include "picolo/geometry/pose2.hpp"
#include "support/property.hpp"

namespace picolo {
namespace {

using test::number;

constexpr double kPi = 3.14159265358979324;

Pose2d any_pose() {
  const double x = *number(-1000.0, 1000.0);
  const double y = *number(-1000.0, 1000.0);
  const double theta = *number(-kPi, kPi);
  return {x, y, theta};
}

bool near(const Pose2d& a, const Pose2d& b, double tolerance) {
  return std::abs(a.x_m - b.x_m) <= tolerance && std::abs(a.y_m - b.y_m) <= tolerance &&
         std::abs(wrap_angle(a.theta_rad - b.theta_rad)) <= tolerance;
}

RC_GTEST_PROP(Se2Group, CompositionIsAssociativeWithIdentityAndInverse, ()) {
  const Pose2d a = any_pose();
  const Pose2d b = any_pose();
  const Pose2d c = any_pose();
  RC_ASSERT(near((a * b) * c, a * (b * c), 1e-11));
  RC_ASSERT(near(a * Pose2d{}, a, 1e-12));
  RC_ASSERT(near(Pose2d{} * a, a, 1e-12));
  RC_ASSERT(near(a * inverse(a), {}, 1e-11));
  RC_ASSERT(near(inverse(a) * a, {}, 1e-11));
  RC_ASSERT(near(inverse(a * b), inverse(b) * inverse(a), 1e-11));
}

RC_GTEST_PROP(Se2Group, BetweenIsTheMissingFactor, ()) {
  const Pose2d a = any_pose();
  const Pose2d b = any_pose();
  RC_ASSERT(near(a * between(a, b), b, 1e-11));
  RC_ASSERT(near(between(a, a * b), b, 1e-11));
}

RC_GTEST_PROP(Se2Group, TransformsKeepDistancesAndCompose, ()) {
  const Pose2d a = any_pose();
  const Pose2d b = any_pose();
  const Point2<double> p{*number(-100.0, 100.0), *number(-100.0, 100.0)};
  const Point2<double> q{*number(-100.0, 100.0), *number(-100.0, 100.0)};
  const Point2<double> ap = transform(a, p);
  const Point2<double> aq = transform(a, q);
  RC_ASSERT(std::abs(std::hypot(ap.x_m - aq.x_m, ap.y_m - aq.y_m) -
                     std::hypot(p.x_m - q.x_m, p.y_m - q.y_m)) <= 1e-12 * 4000);
  const Point2<double> abp = transform(a * b, p);
  const Point2<double> stepwise = transform(a, transform(b, p));
  RC_ASSERT(std::abs(abp.x_m - stepwise.x_m) <= 1e-11);
  RC_ASSERT(std::abs(abp.y_m - stepwise.y_m) <= 1e-11);
}

RC_GTEST_PROP(Se2Maps, ExpAndLogAreInverse, ()) {
  const double theta = *number(-3.1, 3.1) * *rc::gen::element(1.0, 1e-3, 1e-9, 0.0);
  const Tangent2<double> tau{*number(-100.0, 100.0), *number(-100.0, 100.0), theta};
  const Tangent2<double> back = log_se2(exp_se2(tau));
  RC_ASSERT(std::abs(back.x_m - tau.x_m) <= 1e-10);
  RC_ASSERT(std::abs(back.y_m - tau.y_m) <= 1e-10);
  RC_ASSERT(std::abs(back.theta_rad - tau.theta_rad) <= 1e-14);
  const Pose2d pose = any_pose();
  RC_ASSERT(near(exp_se2(log_se2(pose)), pose, 1e-9));
}

RC_GTEST_PROP(Se2Maps, AConstantTwistIsAOneParameterGroup, ()) {
  const Tangent2<double> tau{*number(-2.0, 2.0), *number(-2.0, 2.0), *number(-1.5, 1.5)};
  const double share = *number(0.0, 1.0);
  const Tangent2<double> first{share * tau.x_m, share * tau.y_m, share * tau.theta_rad};
  const Tangent2<double> rest{tau.x_m - first.x_m, tau.y_m - first.y_m,
                              tau.theta_rad - first.theta_rad};
  RC_ASSERT(near(exp_se2(first) * exp_se2(rest), exp_se2(tau), 1e-14));
}

RC_GTEST_PROP(Se2Maps, InterpolationStaysBetweenItsEndsOnTheShorterArc, ()) {
  const Pose2d from = any_pose();
  const Pose2d to = any_pose();
  const double share = *number(0.0, 1.0);
  const Pose2d between_them = interpolate(from, to, share);
  const double whole_arc = std::abs(wrap_angle(to.theta_rad - from.theta_rad));
  const double arc = std::abs(wrap_angle(between_them.theta_rad - from.theta_rad));
  RC_ASSERT(std::abs(arc - share * whole_arc) <= 1e-14);
  const double whole = std::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
  const double part = std::hypot(between_them.x_m - from.x_m, between_them.y_m - from.y_m);
  RC_ASSERT(std::abs(part - share * whole) <= 1e-12 * 4000);
}

RC_GTEST_PROP(Angles, WrappingKeepsTheDirectionAndIsIdempotent, ()) {
  const double angle = *number(-1e5, 1e5);
  const double wrapped = wrap_angle(angle);
  RC_ASSERT(wrapped >= -kPi && wrapped <= kPi);
  RC_ASSERT(wrap_angle(wrapped) == wrapped);
  RC_ASSERT(std::abs(std::remainder(angle - wrapped, 2 * kPi)) <= 1e-10);
}

RC_GTEST_PROP(Covariances, PropagationKeepsSymmetryAndPositiveDiagonals, ()) {
  const Matrix3d covariance =
      Matrix3d::diagonal(*number(0.0, 1.0), *number(0.0, 1.0), *number(0.0, 1.0));
  const Matrix3d moved = propagate(adjoint(any_pose()), covariance);
  for (std::size_t row = 0; row < 3; ++row) {
    RC_ASSERT(moved(row, row) >= 0.0);
    for (std::size_t column = 0; column < 3; ++column) {
      RC_ASSERT(moved(row, column) == moved(column, row));
    }
  }
}

}  // namespace
}  // namespace picolo
