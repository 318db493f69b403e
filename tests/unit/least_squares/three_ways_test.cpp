// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The three classical ways to least squares on the same systems: what each loses with the condition
// number.

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "picolo/geometry/jacobi_svd.hpp"
#include "picolo/solve/svd_least_squares.hpp"
#include "picolo/solve/normal_least_squares.hpp"
#include "picolo/solve/streaming_least_squares.hpp"
#include "random_system.hpp"

namespace picolo {
namespace {

using test::make_system;
using test::row_of;
using test::System;

constexpr std::size_t kUnknowns = 6;
constexpr Eigen::Index kRows = 60;

double error_of(std::span<const double> x, const System& system) {
  const Eigen::Map<const Eigen::VectorXd> found{x.data(), static_cast<Eigen::Index>(x.size())};
  return (found - system.x).norm() / system.x.norm();
}

double qr_error(const System& system) {
  StreamingLeastSquares<kUnknowns> solver;
  for (Eigen::Index k = 0; k < kRows; ++k) {
    EXPECT_EQ(solver.core().add(row_of<kUnknowns>(system, k), system.b[k]), Status::ok);
  }
  std::array<double, kUnknowns> x{};
  return is_ok(solver.solve(x)) ? error_of(x, system) : std::numeric_limits<double>::infinity();
}

double normal_error(const System& system) {
  NormalLeastSquares solver{kUnknowns};
  for (Eigen::Index k = 0; k < kRows; ++k) {
    EXPECT_EQ(solver.add(row_of<kUnknowns>(system, k), system.b[k]), Status::ok);
  }
  std::array<double, kUnknowns> x{};
  return is_ok(solver.solve(x)) ? error_of(x, system) : std::numeric_limits<double>::infinity();
}

double svd_error(const System& system) {
  std::array<double, kUnknowns * kRows> a{};
  Eigen::Map<Eigen::MatrixXd>(a.data(), kRows, kUnknowns) = system.a;
  std::array<double, kUnknowns> x{};
  std::array<double, kUnknowns * kUnknowns> v{};
  EXPECT_EQ(svd_least_squares(a, kRows, {system.b.data(), static_cast<std::size_t>(kRows)}, x, v),
            Status::ok);
  return error_of(x, system);
}

TEST(ThreeWays, AgreeOnAWellConditionedSystem) {
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    const System system = make_system(seed, kRows, kUnknowns, 10.0, 0.1);
    EXPECT_LT(qr_error(system), 1e-13);
    EXPECT_LT(normal_error(system), 1e-12);
    EXPECT_LT(svd_error(system), 1e-13);
  }
}

TEST(ThreeWays, OrthogonalMethodsLoseTheConditionNumberOnce) {
  const System system = make_system(4, kRows, kUnknowns, 1e8, 0.0);
  EXPECT_LT(qr_error(system), 1e-7);
  EXPECT_LT(svd_error(system), 1e-7);
}

TEST(ThreeWays, NormalEquationsSquareIt) {
  const System mild = make_system(4, kRows, kUnknowns, 1e5, 0.0);
  EXPECT_GT(normal_error(mild), 10.0 * qr_error(mild));
  const System harsh = make_system(4, kRows, kUnknowns, 1e8, 0.0);
  EXPECT_GT(normal_error(harsh), 1e-3);  // or refused: infinity
}

TEST(JacobiSvd, FactorsTheMatrix) {
  for (std::uint64_t seed = 1; seed < 40; ++seed) {
    const System system = make_system(seed, kRows, kUnknowns, 1e6, 0.0);
    Eigen::MatrixXd left = system.a;
    Eigen::MatrixXd right(kUnknowns, kUnknowns);
    std::array<double, kUnknowns> values{};
    ASSERT_EQ(
        jacobi_svd({left.data(), kUnknowns * kRows}, kRows, kUnknowns, {right.data(), 36}, values),
        Status::ok);
    EXPECT_LT((left * right.transpose() - system.a).norm(), 1e-14);
    EXPECT_LT((right.transpose() * right - Eigen::MatrixXd::Identity(6, 6)).norm(), 1e-14);
    const Eigen::VectorXd expected = system.a.jacobiSvd().singularValues();
    for (std::size_t k = 0; k < kUnknowns; ++k) {
      EXPECT_NEAR(values[k], expected[static_cast<Eigen::Index>(k)], 1e-12 * expected[0]);
      if (k > 0) { EXPECT_LE(values[k], values[k - 1]); }
    }
  }
}

TEST(JacobiSvd, TakesTheMinimumNormWhenTheRankIsShort) {
  std::array<double, 6> a{1, 2, 3, 2, 4, 6};  // second column is twice the first
  const std::array<double, 3> b{5, 10, 15};
  std::array<double, 2> x{};
  std::array<double, 4> v{};
  ASSERT_EQ(svd_least_squares(a, 3, b, x, v, 1e-12), Status::ok);
  EXPECT_NEAR(x[0], 1.0, 1e-12);
  EXPECT_NEAR(x[1], 2.0, 1e-12);
}

TEST(JacobiSvd, ZeroMatrixAndWrongSizes) {
  std::array<double, 4> a{};
  std::array<double, 4> v{};
  std::array<double, 2> s{1.0, 1.0};
  EXPECT_EQ(jacobi_svd(a, 2, 2, v, s), Status::ok);
  EXPECT_EQ(s, (std::array<double, 2>{0.0, 0.0}));
  EXPECT_EQ(jacobi_svd(a, 1, 2, v, s), Status::invalid_argument);
  EXPECT_EQ(jacobi_svd(a, 2, 2, std::span{v}.first(3), s), Status::invalid_argument);
  std::array<double, 3> b{};
  EXPECT_EQ(svd_least_squares(a, 2, b, s, v), Status::invalid_argument);
}

TEST(Symmetric, InverseTimesMatrixIsIdentityAcrossUnits) {
  Eigen::Matrix3d m;
  m << 4e12, 1e3, 2e6, 1e3, 3e-4, 1e-2, 2e6, 1e-2, 9e3;
  Eigen::Matrix3d inverse;
  ASSERT_EQ(invert_symmetric({m.data(), 9}, {inverse.data(), 9}), Status::ok);
  const Eigen::Vector3d scale = m.diagonal().cwiseSqrt();
  const Eigen::Matrix3d product =
      scale.asDiagonal() * (inverse * m) * scale.cwiseInverse().asDiagonal();
  EXPECT_LT((product - Eigen::Matrix3d::Identity()).norm(), 1e-12);
}

TEST(Symmetric, RefusesIndefiniteAndWrongSizes) {
  const std::array<double, 4> indefinite{1, 2, 2, 1};
  const std::array<double, 2> b{1, 1};
  std::array<double, 2> x{3, 4};
  std::array<double, 4> inverse{};
  EXPECT_EQ(solve_symmetric(indefinite, b, x), Status::degenerate);
  EXPECT_EQ(x, (std::array<double, 2>{3, 4}));
  EXPECT_EQ(invert_symmetric(indefinite, inverse), Status::degenerate);
  EXPECT_EQ(invert_symmetric(std::array<double, 4>{}, inverse), Status::degenerate);
  EXPECT_EQ(invert_symmetric(std::array<double, 3>{}, inverse), Status::invalid_argument);
  EXPECT_EQ(solve_symmetric(b, b, x), Status::invalid_argument);
}

TEST(NormalLeastSquares, CountsResetsAndRefuses) {
  NormalLeastSquares solver{2};
  std::array<double, 2> x{};
  std::array<double, 4> covariance{};
  EXPECT_EQ(solver.solve(x), Status::degenerate);
  EXPECT_EQ(solver.add(std::array<double, 3>{}, 1.0), Status::invalid_argument);
  EXPECT_EQ(solver.add(x, std::numeric_limits<double>::quiet_NaN()), Status::invalid_argument);
  ASSERT_EQ(solver.add(std::array<double, 2>{2, 0}, 4.0), Status::ok);
  ASSERT_EQ(solver.add(std::array<double, 2>{0, 1}, 3.0, 2.0), Status::ok);
  ASSERT_EQ(solver.solve(x), Status::ok);
  EXPECT_NEAR(x[0], 2.0, 1e-15);
  EXPECT_NEAR(x[1], 3.0, 1e-15);
  ASSERT_EQ(solver.covariance(covariance), Status::ok);
  EXPECT_NEAR(covariance[0], 0.25, 1e-15);
  EXPECT_NEAR(covariance[3], 0.25, 1e-15);
  EXPECT_EQ(solver.covariance(x), Status::invalid_argument);
  EXPECT_EQ(solver.solve(covariance), Status::invalid_argument);
  EXPECT_EQ(solver.rows(), 2U);
  solver.reset();
  EXPECT_EQ(solver.rows(), 0U);
}

}  // namespace
}  // namespace picolo
