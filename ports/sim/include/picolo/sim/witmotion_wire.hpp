// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Frames of the WitMotion standard protocol: 11 bytes, 55 | type | 4 x i16 little-endian | sum of
/// the first ten.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace picolo::inline v0::sim {

inline constexpr std::size_t kWitMotionFrameSize = 11;
/// X y z in 16 g / 32768, temperature in 0.01 deg C.
inline constexpr std::uint8_t kWitMotionAcceleration = 0x51;
/// X y z in 2000 deg/s / 32768, voltage in 0.01 V.
inline constexpr std::uint8_t kWitMotionRate = 0x52;
/// Roll pitch yaw in 180 deg / 32768, version.
inline constexpr std::uint8_t kWitMotionAngle = 0x53;

struct WitMotionFrame {
  std::uint8_t type = kWitMotionAcceleration;
  std::array<std::int16_t, 4> words{};
};

[[nodiscard]] std::array<std::uint8_t, kWitMotionFrameSize> encode(const WitMotionFrame& frame);

}  // namespace picolo::inline v0::sim
