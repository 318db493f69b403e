// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the controller says on the CAN bus. Little-endian, two frames of 8 bytes each time.
///
/// | frame | byte 0 | 1 | 2 | 3 | 4 | 5 | 6 | 7 |
/// |---|---|---|---|---|---|---|---|---|
/// | pose | x, i24, mm |  |  | y, i24, mm |  |  | yaw, i16, 0.1 mrad |  |
/// | health | counter | state | reason | match age, u8, 10 ms | position sigma, u16, mm |  | yaw
/// sigma, u16, 0.1 mrad |  |
///
/// Values outside of a field's range are clamped to it. The counter rises by one with each pair.
#pragma once

#include <cstdint>

#include "picolo/controller/controller_config.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/localisation/pose_estimate.hpp"

namespace picolo::inline v0 {

/// Cost: O(1). Context: any.
[[nodiscard]] CanFrame encode_pose(const FramesOutConfig& config, const PoseEstimate& estimate);
[[nodiscard]] CanFrame encode_health(const FramesOutConfig& config, const PoseEstimate& estimate,
                                     std::uint8_t counter);

}  // namespace picolo::inline v0
