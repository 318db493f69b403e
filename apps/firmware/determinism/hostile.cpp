// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What a customer's own code may do to a linked picolo: the same Eigen templates as the library,
// but vectorised and with fused multiply-adds. If the linker took these for the library's, its bits
// would change.

#include <Eigen/Dense>

namespace picolo {

double hostile_eigen(double seed);

double hostile_eigen(double seed) {
  const auto work = [seed]<typename T, int N>(Eigen::Matrix<T, N, N>) {
    using Square = Eigen::Matrix<T, N, N>;
    Square a = Square::Identity() * static_cast<T>(2.0 + seed);
    for (int i = 0; i < N; ++i) {
      a(i, (i + 1) % N) += static_cast<T>(seed) / static_cast<T>(i + 1);
    }
    const Square s = a * a.transpose();
    const Eigen::Matrix<T, N, 1> x = s.ldlt().solve(a.col(0));
    const Eigen::JacobiSVD<Square> svd{s, Eigen::ComputeFullU | Eigen::ComputeFullV};
    const Eigen::SelfAdjointEigenSolver<Square> eigen{s};
    return static_cast<double>(x.sum() + svd.singularValues()(0) + eigen.eigenvalues()(0) +
                               a.inverse().sum());
  };
  return work(Eigen::Matrix3d{}) + work(Eigen::Matrix3f{});
}

}  // namespace picolo
