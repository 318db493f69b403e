// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/solve/streaming_least_squares.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <vector>

#include "random_system.hpp"
#include "support/property.hpp"

namespace picolo {
namespace {

using test::make_system;
using test::row_of;
using test::System;

class Folded {
 public:
  explicit Folded(const System& system, bool backwards = false)
      : unknowns_(static_cast<std::size_t>(system.a.cols())), core_(storage_, unknowns_) {
    for (Eigen::Index k = 0; k < system.a.rows(); ++k) {
      const Eigen::Index row = backwards ? system.a.rows() - 1 - k : k;
      const auto values = row_of(system, row);
      EXPECT_EQ(core_.add(std::span{values}.first(unknowns_), system.b[row]), Status::ok);
    }
  }
  Folded(const Folded&) = delete;
  Folded& operator=(const Folded&) = delete;

  StreamingLeastSquaresCore& core() { return core_; }
  Eigen::VectorXd solution() {
    Eigen::VectorXd x(static_cast<Eigen::Index>(unknowns_));
    EXPECT_EQ(core_.solve({x.data(), unknowns_}), Status::ok);
    return x;
  }

 private:
  std::array<double, square_root_size(kMaxUnknowns)> storage_{};
  std::size_t unknowns_;
  StreamingLeastSquaresCore core_;
};

TEST(StreamingLeastSquares, SolutionAgreesWithADenseDecomposition) {
  const bool held = rc::check("any well-conditioned system", [] {
    const auto seed = *rc::gen::inRange<std::uint64_t>(1, 1'000'000);
    const auto columns = *rc::gen::inRange<Eigen::Index>(1, 10);
    const auto rows = columns + *rc::gen::inRange<Eigen::Index>(0, 60);
    const System system = make_system(seed, rows, columns, 100.0, 0.1);
    RC_ASSERT((Folded{system}.solution() - system.x).norm() < 1e-11 * (1.0 + system.x.norm()));
  });
  EXPECT_TRUE(held);
}

TEST(StreamingLeastSquares, OrderOfRowsChangesNothingButRounding) {
  for (std::uint64_t seed = 1; seed < 30; ++seed) {
    const System system = make_system(seed, 50, 6, 1e3, 0.2);
    Folded forwards{system};
    Folded backwards{system, true};
    EXPECT_LT((forwards.solution() - backwards.solution()).norm(), 1e-9);
    EXPECT_NEAR(forwards.core().residual_squares(), backwards.core().residual_squares(), 1e-12);
  }
}

TEST(StreamingLeastSquares, ResidualIsThatOfTheMinimiser) {
  const System system = make_system(5, 40, 4, 10.0, 0.3);
  const double expected = (system.a * system.x - system.b).squaredNorm();
  EXPECT_NEAR(Folded{system}.core().residual_squares(), expected, 1e-12);
}

TEST(StreamingLeastSquares, CovarianceIsTheInverseOfTheInformation) {
  const System system = make_system(9, 80, 9, 50.0, 0.0);
  Folded folded{system};
  Eigen::Matrix<double, 9, 9> covariance;
  ASSERT_EQ(folded.core().covariance({covariance.data(), 81}), Status::ok);
  const Eigen::MatrixXd expected = (system.a.transpose() * system.a).inverse();
  EXPECT_LT((covariance - expected).norm(), 1e-9 * expected.norm());
  EXPECT_EQ((covariance - covariance.transpose()).norm(), 0.0);
}

TEST(StreamingLeastSquares, WeightTwoCountsLikeFourEqualRows) {
  StreamingLeastSquares<2> once;
  StreamingLeastSquares<2> repeated;
  ASSERT_EQ(once.add({1.0, 2.0}, 3.0, 2.0), Status::ok);
  for (int i = 0; i < 4; ++i) { ASSERT_EQ(repeated.add({1.0, 2.0}, 3.0), Status::ok); }
  ASSERT_EQ(once.add({-1.0, 1.0}, 0.5), Status::ok);
  ASSERT_EQ(repeated.add({-1.0, 1.0}, 0.5), Status::ok);
  ASSERT_EQ(once.add({0.3, 1.0}, 0.7), Status::ok);
  ASSERT_EQ(repeated.add({0.3, 1.0}, 0.7), Status::ok);
  std::array<double, 2> x{};
  std::array<double, 2> y{};
  ASSERT_EQ(once.solve(x), Status::ok);
  ASSERT_EQ(repeated.solve(y), Status::ok);
  EXPECT_NEAR(x[0], y[0], 1e-14);
  EXPECT_NEAR(x[1], y[1], 1e-14);
}

TEST(StreamingLeastSquares, MergingEqualsFoldingAllRows) {
  const System first = make_system(21, 30, 5, 20.0, 0.1);
  System second = make_system(22, 30, 5, 20.0, 0.1);
  System both;
  both.a.resize(60, 5);
  both.b.resize(60);
  both.a << first.a, second.a;
  both.b << first.b, second.b;
  Folded left{first};
  Folded right{second};
  Folded together{both};
  ASSERT_EQ(left.core().merge(right.core()), Status::ok);
  EXPECT_LT((left.solution() - together.solution()).norm(), 1e-12);
  EXPECT_NEAR(left.core().residual_squares(), together.core().residual_squares(), 1e-11);
  EXPECT_EQ(left.core().rows(), 60U);
}

TEST(StreamingLeastSquares, GivenTooFewDirectionsThenDegenerateAndUntouched) {
  StreamingLeastSquares<3> solver;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.1 * i;
    ASSERT_EQ(solver.add({1.0, t, 1.0 + t}, t), Status::ok);  // third column = first + second
  }
  std::array<double, 3> x{7.0, 8.0, 9.0};
  std::array<double, 9> covariance{};
  EXPECT_EQ(solver.solve(x), Status::degenerate);
  EXPECT_EQ(x, (std::array<double, 3>{7.0, 8.0, 9.0}));
  EXPECT_EQ(solver.covariance(covariance), Status::degenerate);
  EXPECT_EQ(StreamingLeastSquares<3>{}.solve(x), Status::degenerate);
}

TEST(Observability, NamesTheUnobservableDirection) {
  StreamingLeastSquares<3> solver;
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(solver.add({1.0, 0.1 * i, 1.0 + 0.1 * i}, 0.0), Status::ok);
  }
  const Observability seen = solver.core().observability();
  EXPECT_EQ(seen.rank, 2U);
  EXPECT_GT(seen.condition, 1e12);
  const double third = 1.0 / std::sqrt(3.0);  // null space of a + b - c
  const double sign = seen.weakest[0] > 0.0 ? 1.0 : -1.0;
  EXPECT_NEAR(sign * seen.weakest[0], third, 1e-9);
  EXPECT_NEAR(sign * seen.weakest[1], third, 1e-9);
  EXPECT_NEAR(sign * seen.weakest[2], -third, 1e-9);
}

TEST(Observability, ConditionIsThatOfTheMatrix) {
  for (const double condition : {1.0, 10.0, 1e4, 1e8}) {
    const System system = make_system(3, 40, 6, condition, 0.0);
    Folded folded{system};
    EXPECT_NEAR(folded.core().observability().condition, condition, 1e-6 * condition);
    EXPECT_EQ(folded.core().observability().rank, 6U);
  }
}

TEST(Observability, ScaleSaysWhichStepsMatterEqually) {
  StreamingLeastSquares<2> solver;
  ASSERT_EQ(solver.add({1.0, 0.0}, 0.0), Status::ok);
  ASSERT_EQ(solver.add({0.0, 1e-3}, 0.0), Status::ok);
  EXPECT_NEAR(solver.core().observability().condition, 1e3, 1e-9);
  EXPECT_EQ(solver.core().observability().weakest_unknown(), 1U);
  const std::array<double, 2> scale{1.0, 1e3};
  EXPECT_NEAR(solver.core().observability(scale).condition, 1.0, 1e-12);
}

TEST(Observability, WithoutRowsNothingIsObservable) {
  const Observability seen = StreamingLeastSquares<4>{}.core().observability();
  EXPECT_EQ(seen.rank, 0U);
  EXPECT_TRUE(std::isinf(seen.condition));
}

TEST(StreamingLeastSquares, RefusesWhatIsNotANumberAndChangesNothing) {
  StreamingLeastSquares<2> solver;
  ASSERT_EQ(solver.add({1.0, 0.0}, 2.0), Status::ok);
  ASSERT_EQ(solver.add({0.0, 1.0}, 3.0), Status::ok);
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solver.add({kNan, 1.0}, 1.0), Status::invalid_argument);
  EXPECT_EQ(solver.add({1.0, 1.0}, std::numeric_limits<double>::infinity()),
            Status::invalid_argument);
  EXPECT_EQ(solver.add({1.0, 1.0}, 1.0, kNan), Status::invalid_argument);
  EXPECT_EQ(solver.core().add(std::array<double, 3>{1, 1, 1}, 1.0), Status::invalid_argument);
  std::array<double, 2> x{};
  ASSERT_EQ(solver.solve(x), Status::ok);
  EXPECT_EQ(x, (std::array<double, 2>{2.0, 3.0}));
  EXPECT_EQ(solver.core().rows(), 2U);
  solver.reset();
  EXPECT_EQ(solver.core().rows(), 0U);
}

TEST(StreamingLeastSquares, WrongSizesAreRefused) {
  StreamingLeastSquares<2> two;
  StreamingLeastSquares<3> three;
  std::array<double, 3> x{};
  EXPECT_EQ(two.core().merge(three.core()), Status::invalid_argument);
  EXPECT_EQ(two.core().solve(x), Status::invalid_argument);
  EXPECT_EQ(two.core().covariance(x), Status::invalid_argument);
}

TEST(StreamingLeastSquares, SurvivesAMillionRowsInTheSameMemory) {
  StreamingLeastSquares<2> solver;
  Random random{17};
  for (int i = 0; i < 1'000'000; ++i) {
    const double u = random.uniform(-1.0, 1.0);
    const double noise = random.uniform(-0.5, 0.5);
    ASSERT_EQ(solver.add({1.0, u}, 0.25 - 3.0 * u + noise), Status::ok);
  }
  std::array<double, 2> x{};
  ASSERT_EQ(solver.solve(x), Status::ok);
  EXPECT_NEAR(x[0], 0.25, 2e-3);
  EXPECT_NEAR(x[1], -3.0, 2e-3);
  static_assert(sizeof(StreamingLeastSquares<2>) < 100);
}

}  // namespace
}  // namespace picolo
