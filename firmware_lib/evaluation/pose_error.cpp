// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/evaluation/pose_error.hpp"

#include <numbers>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

double distance_from_identity(const Transform3d& error) {
  double squares = 0.0;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 3; ++column) {
      const double entry = error.rotation(row, column) - (row == column ? 1.0 : 0.0);
      squares += entry * entry;
    }
  }
  return square_root(squares + dot(error.translation_m, error.translation_m));
}

double measure(const Transform3d& error, PoseRelation relation) {
  switch (relation) {
    case PoseRelation::translation: return norm(error.translation_m);
    case PoseRelation::rotation_rad: return rotation_angle_rad(error.rotation);
    case PoseRelation::rotation_deg:
      return rotation_angle_rad(error.rotation) * (180.0 / std::numbers::pi);
    case PoseRelation::full: break;
  }
  return distance_from_identity(error);
}

}  // namespace

double absolute_error(const Transform3d& reference, const Transform3d& estimate,
                      PoseRelation relation) {
  if (relation == PoseRelation::translation) {  // the same number without the rotation's rounding
    return norm(difference(estimate.translation_m, reference.translation_m));
  }
  return measure(between(estimate, reference), relation);
}

double relative_error(const Transform3d& reference_from, const Transform3d& reference_to,
                      const Transform3d& estimate_from, const Transform3d& estimate_to,
                      PoseRelation relation) {
  return measure(
      between(between(reference_from, reference_to), between(estimate_from, estimate_to)),
      relation);
}

Status absolute_errors(std::span<const Transform3d> reference,
                       std::span<const Transform3d> estimate, PoseRelation relation,
                       std::span<double> errors) {
  if (reference.empty() || reference.size() != estimate.size() ||
      errors.size() != reference.size()) {
    return Status::invalid_argument;
  }
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i] = absolute_error(reference[i], estimate[i], relation);
  }
  return Status::ok;
}

Status relative_errors(std::span<const Transform3d> reference,
                       std::span<const Transform3d> estimate, std::span<const IndexPair> pairs,
                       PoseRelation relation, std::span<double> errors) {
  if (reference.size() != estimate.size() || errors.size() != pairs.size()) {
    return Status::invalid_argument;
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const auto [from, to] = pairs[i];
    if (from >= reference.size() || to >= reference.size()) { return Status::out_of_range; }
    errors[i] =
        relative_error(reference[from], reference[to], estimate[from], estimate[to], relation);
  }
  return Status::ok;
}

}  // namespace picolo::inline v0
