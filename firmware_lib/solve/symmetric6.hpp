// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Dense symmetric 6x6 kernels for float and double: Eigen's own of this size refer to malloc at
/// link level.
#pragma once

#include <array>
#include <cstddef>

#include "picolo/core/math.hpp"

namespace picolo::inline v0::symmetric6 {

inline constexpr std::size_t kN = 6;
template <typename T>
using Matrix = std::array<T, kN * kN>;  // row-major
template <typename T>
using Vector = std::array<T, kN>;

/// L D L^T without pivoting, in place: L below the diagonal, D on it. False when a pivot is not
/// above `T`'s rounding of its diagonal element.
template <typename T>
bool factorise(Matrix<T>& m) {
  constexpr T kSmallestPivot = sizeof(T) == 4 ? T(1e-6) : T(1e-14);
  for (std::size_t j = 0; j < kN; ++j) {
    const T diagonal = m[j * kN + j];
    T pivot = diagonal;
    for (std::size_t k = 0; k < j; ++k) { pivot -= m[j * kN + k] * m[j * kN + k] * m[k * kN + k]; }
    if (!(pivot > kSmallestPivot * diagonal) || !is_finite(pivot)) { return false; }
    m[j * kN + j] = pivot;
    for (std::size_t i = j + 1; i < kN; ++i) {
      T sum = m[i * kN + j];
      for (std::size_t k = 0; k < j; ++k) { sum -= m[i * kN + k] * m[j * kN + k] * m[k * kN + k]; }
      m[i * kN + j] = sum / pivot;
    }
  }
  return true;
}

/// Solves with the result of `factorise`, in place.
template <typename T>
void substitute(const Matrix<T>& factor, Vector<T>& x) {
  for (std::size_t i = 0; i < kN; ++i) {
    for (std::size_t k = 0; k < i; ++k) { x[i] -= factor[i * kN + k] * x[k]; }
  }
  for (std::size_t i = 0; i < kN; ++i) { x[i] /= factor[i * kN + i]; }
  for (std::size_t i = kN; i-- > 0;) {
    for (std::size_t k = i + 1; k < kN; ++k) { x[i] -= factor[k * kN + i] * x[k]; }
  }
}

template <typename T>
struct Eigen6 {
  Vector<T> values{};   ///< ascending
  Matrix<T> vectors{};  ///< rows
};

/// Cyclic Jacobi (Golub, van Loan 8.5), at most 12 sweeps; equal values keep their order.
template <typename T>
Eigen6<T> eigen(Matrix<T> m) {
  constexpr T kEpsilon = sizeof(T) == 4 ? T(6e-8) : T(1.2e-16);
  Matrix<T> v{};
  for (std::size_t i = 0; i < kN; ++i) { v[i * kN + i] = T(1); }
  for (int sweep = 0; sweep < 12; ++sweep) {
    bool rotated = false;
    for (std::size_t p = 0; p + 1 < kN; ++p) {
      for (std::size_t q = p + 1; q < kN; ++q) {
        const T apq = m[p * kN + q];
        const T scale = square_root(m[p * kN + p] < T(0) ? -m[p * kN + p] : m[p * kN + p]) *
                        square_root(m[q * kN + q] < T(0) ? -m[q * kN + q] : m[q * kN + q]);
        if (!((apq < T(0) ? -apq : apq) > kEpsilon * scale)) { continue; }
        rotated = true;
        const T tau = (m[q * kN + q] - m[p * kN + p]) / (T(2) * apq);
        const T root = square_root(T(1) + tau * tau);
        const T t = tau < T(0) ? T(-1) / (root - tau) : T(1) / (root + tau);
        const T c = T(1) / square_root(T(1) + t * t);
        const T s = t * c;
        for (std::size_t k = 0; k < kN; ++k) {
          const T kp = m[k * kN + p];
          const T kq = m[k * kN + q];
          m[k * kN + p] = c * kp - s * kq;
          m[k * kN + q] = s * kp + c * kq;
        }
        for (std::size_t k = 0; k < kN; ++k) {
          const T pk = m[p * kN + k];
          const T qk = m[q * kN + k];
          m[p * kN + k] = c * pk - s * qk;
          m[q * kN + k] = s * pk + c * qk;
          const T vp = v[p * kN + k];
          const T vq = v[q * kN + k];
          v[p * kN + k] = c * vp - s * vq;
          v[q * kN + k] = s * vp + c * vq;
        }
      }
    }
    if (!rotated) { break; }
  }
  Eigen6<T> result;
  std::array<std::size_t, kN> order{0, 1, 2, 3, 4, 5};
  for (std::size_t i = 1; i < kN; ++i) {  // insertion: stable, six elements
    for (std::size_t k = i; k > 0; --k) {
      const std::size_t a = order[k - 1];
      const std::size_t b = order[k];
      if (!(m[b * kN + b] < m[a * kN + a])) { break; }
      order[k - 1] = b;
      order[k] = a;
    }
  }
  for (std::size_t i = 0; i < kN; ++i) {
    result.values[i] = m[order[i] * kN + order[i]];
    for (std::size_t k = 0; k < kN; ++k) { result.vectors[i * kN + k] = v[order[i] * kN + k]; }
  }
  return result;
}

}  // namespace picolo::inline v0::symmetric6
