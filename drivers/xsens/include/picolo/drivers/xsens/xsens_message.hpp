// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The messages of Xsens MTi and MTw: FA FF, identifier, length, data, sum. MTData2 holds items
/// that name their own content.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "picolo/core/bytes.hpp"
#include "picolo/drivers/common/framer.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kXsensMaxData = 512;
inline constexpr std::uint8_t kXsensMtData2 = 0x36;

/// The sum of all bytes behind the first is 0.
struct XsensFormat {
  static constexpr std::size_t kMaxFrame = kXsensMaxData + 7;
  static constexpr bool kVariableSize = true;
  [[nodiscard]] FrameCheck check(ByteView bytes) const;
};

/// What one MTData2 message can say of motion; absent items are not set.
struct XsensData {
  std::optional<std::uint16_t> packet_counter{};
  std::optional<std::uint32_t> sample_time_100us{};
  std::optional<std::array<float, 4>> quaternion{};         ///< w x y z
  std::optional<std::array<float, 3>> euler_deg{};          ///< roll pitch yaw
  std::optional<std::array<float, 3>> acceleration_mps2{};  ///< 4020, else 4040
  std::optional<std::array<float, 3>> rate_radps{};         ///< 8020, else 8040
  std::optional<std::array<float, 3>> magnetic{};
  std::optional<std::uint32_t> status{};
  std::uint8_t unknown_items = 0;
  bool damaged = false;  ///< an item reached past the message, or held a number that is none
};

/// Precondition: checked. `message_id`: what the frame is; items only where it is kXsensMtData2.
[[nodiscard]] std::uint8_t xsens_message_id(ByteView frame);
[[nodiscard]] XsensData parse_xsens(ByteView frame);

}  // namespace picolo::inline v0
