// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/geometry/matrix3.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {

template <typename T>
Matrix3<T> product(const Matrix3<T>& a, const Matrix3<T>& b) {
  Matrix3<T> result;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      result(row, column) =
          (a(row, 0) * b(0, column) + a(row, 1) * b(1, column)) + a(row, 2) * b(2, column);
    }
  }
  return result;
}

template <typename T>
Matrix3<T> sum(const Matrix3<T>& a, const Matrix3<T>& b) {
  Matrix3<T> result;
  for (std::size_t i = 0; i < 9; ++i) { result.elements[i] = a.elements[i] + b.elements[i]; }
  return result;
}

template <typename T>
Matrix3<T> scaled(const Matrix3<T>& a, T factor) {
  Matrix3<T> result = a;
  for (T& element : result.elements) { element *= factor; }
  return result;
}

template <typename T>
Matrix3<T> transpose(const Matrix3<T>& a) {
  Matrix3<T> result;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) { result(row, column) = a(column, row); }
  }
  return result;
}

template <typename T>
Matrix3<T> propagate(const Matrix3<T>& j, const Matrix3<T>& covariance) {
  Matrix3<T> result = product(product(j, covariance), transpose(j));
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < row; ++column) {
      const T mean = (result(row, column) + result(column, row)) / T{2};
      result(row, column) = mean;
      result(column, row) = mean;
    }
  }
  return result;
}

template Matrix3<float> product(const Matrix3<float>&, const Matrix3<float>&);
template Matrix3<double> product(const Matrix3<double>&, const Matrix3<double>&);
template Matrix3<float> sum(const Matrix3<float>&, const Matrix3<float>&);
template Matrix3<double> sum(const Matrix3<double>&, const Matrix3<double>&);
template Matrix3<float> scaled(const Matrix3<float>&, float);
template Matrix3<double> scaled(const Matrix3<double>&, double);
template Matrix3<float> transpose(const Matrix3<float>&);
template Matrix3<double> transpose(const Matrix3<double>&);
template Matrix3<float> propagate(const Matrix3<float>&, const Matrix3<float>&);
template Matrix3<double> propagate(const Matrix3<double>&, const Matrix3<double>&);

}  // namespace picolo::inline v0
