// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/map/likelihood_field.hpp"

#include "picolo/core/number_model.hpp"
#include "picolo/map/bilinear.hpp"

namespace picolo::inline v0 {

FieldSample sample_field(const DistanceFieldView& field, float x_m, float y_m) {
  return sample(field, x_m, y_m);
}

}  // namespace picolo::inline v0
