// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The walk over the residuals, eight lanes at a time; instantiated for float and for double in a
/// file each, so that the double list can name the latter.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"
#include "picolo/solve/line_plane_residuals.hpp"

namespace picolo::inline v0 {
namespace line_plane {

inline constexpr std::size_t kLanes = 8;
template <typename T>
using Lanes = std::array<T, kLanes>;
template <typename T>
using Lanes3 = std::array<Lanes<T>, 3>;

template <typename T>
T fold(const Lanes<T>& lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) +
         ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}

template <typename T>
struct Sums {
  std::array<Lanes<T>, 21> upper{};
  std::array<Lanes<T>, 6> b{};
  Lanes<T> cost{};

  void fold_into(NormalEquations6<T>& system) const {
    for (std::size_t i = 0; i < 21; ++i) { system.upper[i] += fold(upper[i]); }
    for (std::size_t i = 0; i < 6; ++i) { system.b[i] += fold(b[i]); }
    system.cost += fold(cost);
  }
};

template <typename T>
void load(Lanes3<T>& lanes, std::size_t lane, const Vector3<T>& v) {
  lanes[0][lane] = v.x;
  lanes[1][lane] = v.y;
  lanes[2][lane] = v.z;
}

/// arm = R p.
template <typename T>
void rotate_lanes(const Matrix3<T>& r, const Lanes3<T>& p, Lanes3<T>& arm) {
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      arm[row][l] = (r(row, 0) * p[0][l] + r(row, 1) * p[1][l]) + r(row, 2) * p[2][l];
    }
  }
}

/// residual = n . (arm + t - j).
template <typename T>
void project_lanes(const Lanes3<T>& arm, const Vector3<T>& t, const Lanes3<T>& j,
                   const Lanes3<T>& n, Lanes<T>& residual) {
  for (std::size_t l = 0; l < kLanes; ++l) {
    residual[l] = (n[0][l] * (arm[0][l] + t.x - j[0][l]) + n[1][l] * (arm[1][l] + t.y - j[1][l])) +
                  n[2][l] * (arm[2][l] + t.z - j[2][l]);
  }
}

/// One row J = [(R p) x n, n] of all lanes into the sums.
template <typename T>
void add_rows(const Lanes3<T>& arm, const Lanes3<T>& n, const Lanes<T>& residual,
              const Lanes<T>& weight, Sums<T>& sums) {
  std::array<Lanes<T>, 6> j;
  for (std::size_t l = 0; l < kLanes; ++l) {
    j[0][l] = arm[1][l] * n[2][l] - arm[2][l] * n[1][l];
    j[1][l] = arm[2][l] * n[0][l] - arm[0][l] * n[2][l];
    j[2][l] = arm[0][l] * n[1][l] - arm[1][l] * n[0][l];
  }
  j[3] = n[0];
  j[4] = n[1];
  j[5] = n[2];
  std::size_t entry = 0;
  for (std::size_t row = 0; row < 6; ++row) {
    Lanes<T> weighted;
    for (std::size_t l = 0; l < kLanes; ++l) {
      weighted[l] = weight[l] * j[row][l];
      sums.b[row][l] -= weighted[l] * residual[l];
    }
    for (std::size_t column = row; column < 6; ++column, ++entry) {
      for (std::size_t l = 0; l < kLanes; ++l) {
        sums.upper[entry][l] += weighted[l] * j[column][l];
      }
    }
  }
}

template <typename T>
T weight_of(RobustKind kind, T width, T squared) {
  switch (kind) {
    case RobustKind::none: break;
    case RobustKind::huber: return squared <= width * width ? T(1) : width / square_root(squared);
    case RobustKind::geman_mcclure: {
      const T root = T(1) / (T(1) + squared / (width * width));
      return root * root;
    }
  }
  return T(1);
}

template <typename T>
T cost_of(RobustKind kind, T width, T squared) {
  switch (kind) {
    case RobustKind::none: break;
    case RobustKind::huber:
      return squared <= width * width ? squared
                                      : T(2) * width * square_root(squared) - width * width;
    case RobustKind::geman_mcclure: return squared / (T(1) + squared / (width * width));
  }
  return squared;
}

/// `in` is 1 where a lane holds a residual, 0 where it only fills up the last eight.
template <typename T>
void judge_lanes(const RobustKernel& kernel, const Lanes<T>& squared, const Lanes<T>& in,
                 Lanes<T>& weight, Lanes<T>& cost) {
  const T width = static_cast<T>(kernel.width);
  for (std::size_t l = 0; l < kLanes; ++l) {
    weight[l] = in[l] * weight_of(kernel.kind, width, squared[l]);
    cost[l] += in[l] * cost_of(kernel.kind, width, squared[l]) / T(2);
  }
}

template <typename T>
void add_planes(std::span<const PlaneResidual<T>> planes, const Matrix3<T>& rotation,
                const Vector3<T>& t, const RobustKernel& kernel, Sums<T>& sums) {
  Lanes3<T> p{};
  Lanes3<T> arm;
  Lanes3<T> j{};
  Lanes3<T> n{};
  Lanes<T> in{};
  Lanes<T> residual;
  Lanes<T> squared;
  Lanes<T> weight;
  for (std::size_t l = 0; l < planes.size(); ++l) {
    load(p, l, planes[l].point_m);
    load(j, l, planes[l].plane_m);
    load(n, l, planes[l].normal);
    in[l] = T(1);
  }
  rotate_lanes(rotation, p, arm);
  project_lanes(arm, t, j, n, residual);
  for (std::size_t l = 0; l < kLanes; ++l) { squared[l] = residual[l] * residual[l]; }
  judge_lanes(kernel, squared, in, weight, sums.cost);
  add_rows(arm, n, residual, weight, sums);
}

template <typename T>
void add_lines(std::span<const LineResidual<T>> lines, LineForm form, const Matrix3<T>& rotation,
               const Vector3<T>& t, const RobustKernel& kernel, Sums<T>& sums) {
  Lanes3<T> p{};
  Lanes3<T> arm;
  Lanes3<T> a{};
  Lanes3<T> side{};
  Lanes3<T> other{};
  Lanes<T> in{};
  Lanes<T> along_side;
  Lanes<T> along_other;
  Lanes<T> squared;
  Lanes<T> weight;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    load(p, l, lines[l].point_m);
    load(a, l, lines[l].line_m);
    load(side, l, lines[l].side);
    load(other, l, lines[l].other);
    in[l] = T(1);
  }
  rotate_lanes(rotation, p, arm);
  project_lanes(arm, t, a, side, along_side);
  project_lanes(arm, t, a, other, along_other);
  for (std::size_t l = 0; l < kLanes; ++l) {
    squared[l] = along_side[l] * along_side[l] + along_other[l] * along_other[l];
  }
  judge_lanes(kernel, squared, in, weight, sums.cost);
  if (form == LineForm::two_directions) {
    add_rows(arm, side, along_side, weight, sums);
    add_rows(arm, other, along_other, weight, sums);
    return;
  }
  Lanes3<T> away;  // unit, from the line to the point; zero on the line
  Lanes<T> distance;
  for (std::size_t l = 0; l < kLanes; ++l) {
    distance[l] = square_root(squared[l]);
    const T share = distance[l] > T(0) ? T(1) / distance[l] : T(0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      away[axis][l] = share * (along_side[l] * side[axis][l] + along_other[l] * other[axis][l]);
    }
  }
  add_rows(arm, away, distance, weight, sums);
}

}  // namespace line_plane

template <typename T>
T robust_weight(const RobustKernel& kernel, T squared_residual) {
  return line_plane::weight_of(kernel.kind, static_cast<T>(kernel.width), squared_residual);
}

template <typename T>
T robust_cost(const RobustKernel& kernel, T squared_residual) {
  return line_plane::cost_of(kernel.kind, static_cast<T>(kernel.width), squared_residual);
}

template <typename T>
void accumulate(std::type_identity_t<std::span<const PlaneResidual<T>>> planes,
                const Pose3<T>& pose, const RobustKernel& kernel, NormalEquations6<T>& system) {
  line_plane::Sums<T> sums;
  const Matrix3<T> rotation = to_matrix(pose.rotation);
  for (std::size_t k = 0; k < planes.size(); k += line_plane::kLanes) {
    const auto block = planes.subspan(k, std::min(line_plane::kLanes, planes.size() - k));
    line_plane::add_planes(block, rotation, pose.translation_m, kernel, sums);
  }
  sums.fold_into(system);
  system.count += planes.size();
}

template <typename T>
void accumulate(std::type_identity_t<std::span<const LineResidual<T>>> lines, LineForm form,
                const Pose3<T>& pose, const RobustKernel& kernel, NormalEquations6<T>& system) {
  line_plane::Sums<T> sums;
  const Matrix3<T> rotation = to_matrix(pose.rotation);
  for (std::size_t k = 0; k < lines.size(); k += line_plane::kLanes) {
    const auto block = lines.subspan(k, std::min(line_plane::kLanes, lines.size() - k));
    line_plane::add_lines(block, form, rotation, pose.translation_m, kernel, sums);
  }
  sums.fold_into(system);
  system.count += lines.size();
}

template <typename T>
LineResidual<T> line_residual(const Vector3<T>& point_m, const Vector3<T>& a_m,
                              const Vector3<T>& direction) {
  const T length = norm(direction);
  if (!(length > T(0))) { return {point_m, a_m, {}, {}}; }
  const Vector3<T> d = scaled(direction, T(1) / length);
  // Crossed with the axis it is least along: never close to parallel.
  const auto size = [](T x) { return x < T(0) ? -x : x; };
  Vector3<T> axis{T(0), T(0), T(1)};
  if (size(d.x) <= size(d.y) && size(d.x) <= size(d.z)) {
    axis = {T(1), T(0), T(0)};
  } else if (size(d.y) <= size(d.z)) {
    axis = {T(0), T(1), T(0)};
  }
  const Vector3<T> across = cross(d, axis);
  const Vector3<T> side = scaled(across, T(1) / norm(across));
  return {point_m, a_m, side, cross(d, side)};
}

template <typename T>
LineDistance<T> line_distance(const Vector3<T>& p_m, const Vector3<T>& a_m, const Vector3<T>& b_m) {
  const Vector3<T> along = difference(a_m, b_m);
  const Vector3<T> nu = cross(difference(p_m, b_m), difference(p_m, a_m));
  const T length = norm(along);
  const T area = norm(nu);
  if (!(length > T(0)) || !(area > T(0))) { return {}; }
  return {area / length, scaled(cross(nu, along), T(1) / (area * length))};
}

#define PICOLO_INSTANTIATE_LINE_PLANE(T)                                                           \
  template T robust_weight(const RobustKernel&, T);                                                \
  template T robust_cost(const RobustKernel&, T);                                                  \
  template void accumulate(std::span<const PlaneResidual<T>>, const Pose3<T>&,                     \
                           const RobustKernel&, NormalEquations6<T>&);                             \
  template void accumulate(std::span<const LineResidual<T>>, LineForm, const Pose3<T>&,            \
                           const RobustKernel&, NormalEquations6<T>&);                             \
  template LineResidual<T> line_residual(const Vector3<T>&, const Vector3<T>&, const Vector3<T>&); \
  template LineDistance<T> line_distance(const Vector3<T>&, const Vector3<T>&, const Vector3<T>&)

}  // namespace picolo::inline v0
