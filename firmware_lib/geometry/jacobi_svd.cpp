// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/geometry/jacobi_svd.hpp"

#include <algorithm>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) { sum += a[i] * b[i]; }
  return sum;
}

void rotate(std::span<double> p, std::span<double> q, double cosine, double sine) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const double before = p[i];
    p[i] = cosine * before - sine * q[i];
    q[i] = sine * before + cosine * q[i];
  }
}

struct Columns {
  std::span<double> elements;
  std::size_t rows;
  [[nodiscard]] std::span<double> operator[](std::size_t column) const {
    return elements.subspan(column * rows, rows);
  }
};

/// Makes two columns orthogonal; false when they already were.
bool orthogonalise(const Columns& a, const Columns& v, std::size_t p, std::size_t q) {
  const double alpha = dot(a[p], a[p]);
  const double beta = dot(a[q], a[q]);
  const double gamma = dot(a[p], a[q]);
  if (gamma == 0.0 || gamma * gamma <= 1e-30 * alpha * beta) { return false; }
  const double zeta = (beta - alpha) / (2.0 * gamma);
  const double sign = zeta < 0.0 ? -1.0 : 1.0;
  const double tangent = sign / (sign * zeta + hypotenuse(1.0, zeta));
  const double cosine = 1.0 / hypotenuse(1.0, tangent);
  rotate(a[p], a[q], cosine, cosine * tangent);
  rotate(v[p], v[q], cosine, cosine * tangent);
  return true;
}

void sort_descending(const Columns& a, const Columns& v, std::span<double> values) {
  for (std::size_t k = 0; k + 1 < values.size(); ++k) {
    std::size_t best = k;
    for (std::size_t j = k + 1; j < values.size(); ++j) {
      if (values[j] > values[best]) { best = j; }
    }
    for (; best > k; --best) {  // insertion keeps the order of equal ones
      std::swap(values[best], values[best - 1]);
      std::swap_ranges(a[best].begin(), a[best].end(), a[best - 1].begin());
      std::swap_ranges(v[best].begin(), v[best].end(), v[best - 1].begin());
    }
  }
}

}  // namespace

Status jacobi_svd(std::span<double> a, std::size_t rows, std::size_t columns, std::span<double> v,
                  std::span<double> singular_values) {
  if (rows < columns || columns == 0 || a.size() != rows * columns ||
      v.size() != columns * columns || singular_values.size() != columns) {
    return Status::invalid_argument;
  }
  const Columns left{a, rows};
  const Columns right{v, columns};
  std::fill(v.begin(), v.end(), 0.0);
  for (std::size_t k = 0; k < columns; ++k) { right[k][k] = 1.0; }
  constexpr int kMaxSweeps = 30;
  bool changed = true;
  for (int sweep = 0; changed && sweep < kMaxSweeps; ++sweep) {
    changed = false;
    for (std::size_t p = 0; p + 1 < columns; ++p) {
      for (std::size_t q = p + 1; q < columns; ++q) {
        const bool rotated = orthogonalise(left, right, p, q);
        changed = changed || rotated;
      }
    }
  }
  for (std::size_t k = 0; k < columns; ++k) {
    singular_values[k] = square_root(dot(left[k], left[k]));
  }
  sort_descending(left, right, singular_values);
  return changed ? Status::degenerate : Status::ok;
}

}  // namespace picolo::inline v0
