// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/solve/normal_equations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <limits>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

using EigenMatrix = Eigen::Matrix<float, 3, 3, Eigen::RowMajor>;

EigenMatrix to_eigen(const Matrix3f& matrix) {
  return Eigen::Map<const EigenMatrix>(matrix.elements.data());
}

bool all_finite(const Matrix3f& matrix) {
  for (const float element : matrix.elements) {
    if (!is_finite(element)) { return false; }
  }
  return true;
}

}  // namespace

Conditioning conditioning_of(const Matrix3f& information, float length_m) {
  Conditioning result;
  result.condition = std::numeric_limits<float>::infinity();
  if (!all_finite(information)) { return result; }
  const Eigen::Vector3f scale{1.0F, 1.0F, 1.0F / length_m};
  EigenMatrix scaled;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      scaled(row, column) =
          scale(row) * scale(column) *
          information(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
    }
  }
  const Eigen::SelfAdjointEigenSolver<EigenMatrix> solver{scaled};
  if (solver.info() != Eigen::Success) { return result; }
  for (int i = 0; i < 3; ++i) {
    result.eigenvalues[static_cast<std::size_t>(i)] = solver.eigenvalues()(i);
    for (int row = 0; row < 3; ++row) {
      result.eigenvectors(static_cast<std::size_t>(row), static_cast<std::size_t>(i)) =
          solver.eigenvectors()(row, i);
    }
  }
  if (result.eigenvalues[0] > 0.0F) {
    result.condition = result.eigenvalues[2] / result.eigenvalues[0];
  }
  return result;
}

StepSolution solve(const NormalEquations3& system) {
  if (!all_finite(system.h)) { return {}; }
  const Eigen::LDLT<Eigen::Matrix3f> factor{to_eigen(system.h)};
  if (factor.info() != Eigen::Success || !factor.isPositive() ||
      factor.vectorD().minCoeff() <= 0.0F) {
    return {};
  }
  const Eigen::Vector3f step = factor.solve(Eigen::Vector3f{system.b[0], system.b[1], system.b[2]});
  if (!step.allFinite()) { return {}; }
  return {{step(0), step(1), step(2)}, true};
}

namespace {

bool is_open(const Conditioning& conditioning, std::size_t i, float max_condition) {
  const float eigenvalue = conditioning.eigenvalues[i];
  return !(eigenvalue > 0.0F) || eigenvalue * max_condition < conditioning.eigenvalues[2];
}

}  // namespace

int open_directions(const Conditioning& conditioning, float max_condition) {
  int open = 0;
  for (std::size_t i = 0; i < 3; ++i) { open += is_open(conditioning, i, max_condition) ? 1 : 0; }
  return open;
}

NormalEquations3 observable_part(const NormalEquations3& system, const Conditioning& conditioning,
                                 float length_m, float max_condition) {
  const std::array<float, 3> unit{1.0F, 1.0F, length_m};
  const Matrix3f& v = conditioning.eigenvectors;
  NormalEquations3 result;
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_open(conditioning, i, max_condition)) { continue; }
    const float along =
        (v(0, i) * system.b[0] + v(1, i) * system.b[1]) + v(2, i) * (system.b[2] / length_m);
    for (std::size_t row = 0; row < 3; ++row) {
      result.b[row] += unit[row] * v(row, i) * along;
      for (std::size_t column = 0; column < 3; ++column) {
        result.h(row, column) +=
            (unit[row] * v(row, i)) * (unit[column] * v(column, i)) * conditioning.eigenvalues[i];
      }
    }
  }
  return result;
}

StepSolution solve_constrained(const NormalEquations3& system, const Conditioning& conditioning,
                               float length_m, float max_condition) {
  const std::array<float, 3> scaled_b{system.b[0], system.b[1], system.b[2] / length_m};
  StepSolution result;
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_open(conditioning, i, max_condition)) { continue; }
    const float eigenvalue = conditioning.eigenvalues[i];
    const Matrix3f& v = conditioning.eigenvectors;
    const float along =
        ((v(0, i) * scaled_b[0] + v(1, i) * scaled_b[1]) + v(2, i) * scaled_b[2]) / eigenvalue;
    result.step[0] += along * v(0, i);
    result.step[1] += along * v(1, i);
    result.step[2] += along * v(2, i) / length_m;
    result.solved = true;
  }
  return result;
}

Matrix3f covariance_of(const Matrix3f& information, float otherwise) {
  const Matrix3f unknown = Matrix3f::diagonal(otherwise, otherwise, otherwise);
  if (!all_finite(information)) { return unknown; }
  const Eigen::LDLT<Eigen::Matrix3f> factor{to_eigen(information)};
  if (factor.info() != Eigen::Success || !factor.isPositive() ||
      factor.vectorD().minCoeff() <= 0.0F) {
    return unknown;
  }
  // Column by column: Eigen's path for several right-hand sides has a guarded static.
  Eigen::Matrix3f inverse;
  for (int column = 0; column < 3; ++column) {
    inverse.col(column) = factor.solve(Eigen::Vector3f{Eigen::Vector3f::Unit(column)});
  }
  Matrix3f result;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const float mean = 0.5F * (inverse(row, column) + inverse(column, row));
      if (!is_finite(mean)) { return unknown; }
      result(static_cast<std::size_t>(row), static_cast<std::size_t>(column)) = mean;
    }
  }
  return result;
}

}  // namespace picolo::inline v0
