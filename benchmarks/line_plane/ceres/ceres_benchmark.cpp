// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The same residuals with Ceres: analytic cost functions of a rotation vector and a translation
// (left perturbation through a manifold of our own), dense QR, four iterations; and how far its
// converged answer is from picolo's.

#include <benchmark/benchmark.h>
#include <ceres/ceres.h>

#include <algorithm>
#include <array>

#include "problem.hpp"

namespace picolo::bench {
namespace {

/// Parameters: quaternion w x y z, translation x y z; tangent: rotation, translation.
class LeftPerturbation final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* result) const override {
    const Pose3d moved =
        perturbed(Pose3d{{x[0], x[1], x[2], x[3]}, {x[4], x[5], x[6]}},
                  Tangent3<double>{{delta[0], delta[1], delta[2]}, {delta[3], delta[4], delta[5]}});
    const std::array<double, 7> out{
        moved.rotation.w,      moved.rotation.x,      moved.rotation.y,     moved.rotation.z,
        moved.translation_m.x, moved.translation_m.y, moved.translation_m.z};
    std::copy(out.begin(), out.end(), result);
    return true;
  }
  /// Cost functions give the derivative by the tangent in their first six columns.
  bool PlusJacobian(const double* /*x*/, double* jacobian) const override {
    std::fill_n(jacobian, 42, 0.0);
    for (int i = 0; i < 6; ++i) { jacobian[6 * i + i] = 1.0; }
    return true;
  }
  bool Minus(const double* /*y*/, const double* /*x*/, double* /*delta*/) const override {
    return false;
  }
  bool MinusJacobian(const double* /*x*/, double* /*jacobian*/) const override { return false; }
};

Pose3d pose_of(const double* x) {
  return {{x[0], x[1], x[2], x[3]}, {x[4], x[5], x[6]}};
}

void fill_row(const Vector3d& arm, const Vector3d& n, double* row) {
  const Vector3d turn = cross(arm, n);
  const std::array<double, 7> entries{turn.x, turn.y, turn.z, n.x, n.y, n.z, 0.0};
  std::copy(entries.begin(), entries.end(), row);
}

class PlaneCost final : public ceres::SizedCostFunction<1, 7> {
 public:
  explicit PlaneCost(const PlaneResidual<double>& plane) : plane_(plane) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Pose3d pose = pose_of(x[0]);
    const Vector3d arm = rotate(pose.rotation, plane_.point_m);
    residuals[0] = dot(plane_.normal, difference(sum(arm, pose.translation_m), plane_.plane_m));
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      fill_row(arm, plane_.normal, jacobians[0]);
    }
    return true;
  }

 private:
  PlaneResidual<double> plane_;
};

class LineCost final : public ceres::SizedCostFunction<2, 7> {
 public:
  explicit LineCost(const LineResidual<double>& line) : line_(line) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Pose3d pose = pose_of(x[0]);
    const Vector3d arm = rotate(pose.rotation, line_.point_m);
    const Vector3d way = difference(sum(arm, pose.translation_m), line_.line_m);
    residuals[0] = dot(line_.side, way);
    residuals[1] = dot(line_.other, way);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      fill_row(arm, line_.side, jacobians[0]);
      fill_row(arm, line_.other, jacobians[0] + 7);
    }
    return true;
  }

 private:
  LineResidual<double> line_;
};

/// The scalar form |nu| / |a - b| of the same lines.
class DistanceCost final : public ceres::SizedCostFunction<1, 7> {
 public:
  DistanceCost(const LineResidual<double>& line, const Vector3d& direction)
      : point_m_(line.point_m), a_m_(line.line_m), b_m_(sum(line.line_m, direction)) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Pose3d pose = pose_of(x[0]);
    const Vector3d arm = rotate(pose.rotation, point_m_);
    const LineDistance<double> line = line_distance(sum(arm, pose.translation_m), a_m_, b_m_);
    residuals[0] = line.distance_m;
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      fill_row(arm, line.gradient, jacobians[0]);
    }
    return true;
  }

 private:
  Vector3d point_m_;
  Vector3d a_m_;
  Vector3d b_m_;
};

/// Built once; only Ceres' own evaluation and solve are timed.
class CeresProblem {
 public:
  CeresProblem(const Problem& problem, LineForm form) {
    ceres_.AddParameterBlock(x_.data(), 7, new LeftPerturbation);
    for (const auto& plane : problem.planes) {
      ceres_.AddResidualBlock(new PlaneCost{plane}, nullptr, x_.data());
    }
    for (std::size_t i = 0; i < problem.lines.size(); ++i) {
      ceres::CostFunction* cost = nullptr;
      if (form == LineForm::two_directions) {
        cost = new LineCost{problem.lines[i]};
      } else {
        cost = new DistanceCost{problem.lines[i], problem.directions[i]};
      }
      ceres_.AddResidualBlock(cost, nullptr, x_.data());
    }
  }

  Pose3d solve(int iterations) {
    x_ = {1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = iterations;
    options.function_tolerance = 1e-300;
    options.gradient_tolerance = 1e-300;
    options.parameter_tolerance = 1e-16;
    options.logging_type = ceres::SILENT;
    options.num_threads = 1;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &ceres_, &summary);
    return pose_of(x_.data());
  }

 private:
  std::array<double, 7> x_{};
  ceres::Problem ceres_;
};

void ceres_qr(benchmark::State& state, LineForm form) {
  const Problem problem = problem_of(static_cast<std::size_t>(state.range(0)));
  CeresProblem timed{problem, form};
  for (auto _ : state) { benchmark::DoNotOptimize(timed.solve(4)); }
  const Pose3d theirs = CeresProblem{problem, LineForm::two_directions}.solve(50);
  const Pose3d ours =
      PoseSolver<double>{{.max_iterations = 50, .converged_m = 1e-14F, .converged_rad = 1e-14F}}
          .solve({problem.planes, problem.lines, {}})
          .pose;
  state.counters["apart_m"] = norm(difference(theirs.translation_m, ours.translation_m));
  state.counters["apart_rad"] =
      rotation_angle_rad(compose(inverse(theirs.rotation), ours.rotation));
}

BENCHMARK_CAPTURE(ceres_qr, two_directions, LineForm::two_directions)
    ->Arg(200)
    ->Arg(1000)
    ->Arg(5000)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(ceres_qr, distance, LineForm::distance)
    ->Arg(200)
    ->Arg(1000)
    ->Arg(5000)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace picolo::bench
