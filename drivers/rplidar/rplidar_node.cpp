// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/rplidar/rplidar_node.hpp"

#include "picolo/core/number_model.hpp"
#include "picolo/drivers/common/polar.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::int32_t kFullTurnQ14 = 4 * (1 << 14);
constexpr float kUnitsPerMetre = 4000.0F;

}  // namespace

void to_reading(const RplidarNode& node, RangeReading& reading) {
  reading.range_m = static_cast<float>(node.dist_mm_q2) / kUnitsPerMetre;
  reading.bearing_rad =
      clockwise_bearing_rad(static_cast<std::int32_t>(node.angle_z_q14), kFullTurnQ14);
  reading.starts_sweep = (node.flag & 1U) != 0;
}

}  // namespace picolo::inline v0
