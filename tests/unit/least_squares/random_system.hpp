// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Least squares problems with a known answer and a chosen condition number.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <cmath>

#include "picolo/core/random.hpp"

namespace picolo::test {

struct System {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
  Eigen::VectorXd x;  ///< the minimiser
};

inline Eigen::MatrixXd gaussian_matrix(Random& random, Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd m(rows, columns);
  for (Eigen::Index i = 0; i < m.size(); ++i) { m.data()[i] = random.gaussian(); }
  return m;
}

/// Singular values spread evenly in the logarithm from 1 to 1 / condition; the residual is
/// orthogonal to the columns.
inline System make_system(std::uint64_t seed, Eigen::Index rows, Eigen::Index columns,
                          double condition, double residual) {
  Random random{seed};
  const Eigen::MatrixXd left = gaussian_matrix(random, rows, rows).householderQr().householderQ();
  const Eigen::MatrixXd right =
      gaussian_matrix(random, columns, columns).householderQr().householderQ();
  System system;
  Eigen::VectorXd values(columns);
  for (Eigen::Index k = 0; k < columns; ++k) {
    const double share =
        columns > 1 ? static_cast<double>(k) / static_cast<double>(columns - 1) : 0.0;
    values[k] = std::pow(condition, -share);
  }
  system.a = left.leftCols(columns) * values.asDiagonal() * right.transpose();
  system.x = gaussian_matrix(random, columns, 1);
  system.b = system.a * system.x;
  if (rows > columns) { system.b += residual * left.rightCols(rows - columns).rowwise().sum(); }
  return system;
}

/// One row as a plain array, however the matrix is stored.
template <std::size_t Size = 9>
std::array<double, Size> row_of(const System& system, Eigen::Index row) {
  std::array<double, Size> values{};
  for (Eigen::Index k = 0; k < system.a.cols(); ++k) {
    values[static_cast<std::size_t>(k)] = system.a(row, k);
  }
  return values;
}

}  // namespace picolo::test
