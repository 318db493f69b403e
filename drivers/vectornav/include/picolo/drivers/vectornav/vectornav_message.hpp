// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// VectorNav messages, text ("$VNYMR,...*XX") and binary (FA, groups, masks, fields, CRC).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"
#include "picolo/drivers/common/framer.hpp"

namespace picolo::inline v0 {

/// Either kind, in any order. Text closes with an exclusive-or (2 digits) or a CRC (4), binary with
/// a CRC-16-CCITT over everything behind FA.
struct VectornavFormat {
  static constexpr std::size_t kMaxFrame = 600;
  static constexpr bool kVariableSize = true;
  [[nodiscard]] FrameCheck check(ByteView bytes) const;
};

/// What a message can say of motion; absent fields are not set.
struct VectornavData {
  std::optional<std::uint64_t> time_startup_ns{};
  std::optional<std::array<float, 3>> ypr_deg{};
  std::optional<std::array<float, 4>> quaternion{};  ///< x y z w, as the device orders it
  std::optional<std::array<float, 3>> magnetic_gauss{};
  std::optional<std::array<float, 3>> acceleration_mps2{};
  std::optional<std::array<float, 3>> rate_radps{};
  std::optional<float> temperature_degc{};
  std::optional<float> pressure_kpa{};
  bool damaged = false;  ///< a field held a number that is none
};

/// Precondition: checked. `unsupported`: a text message of another kind.
[[nodiscard]] Result<VectornavData> parse_vectornav(ByteView frame);

}  // namespace picolo::inline v0
