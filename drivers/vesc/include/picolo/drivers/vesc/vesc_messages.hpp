// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// VESC status frames: 29-bit identifier = command << 8 | vesc, big-endian. Pure codec.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"

namespace picolo::inline v0 {

enum class VescCommand : std::uint8_t {
  set_current = 1,
  status = 9,
  status_2 = 14,
  status_3 = 15,
  status_4 = 16,
  status_5 = 27,
  status_6 = 58,
};

[[nodiscard]] constexpr std::uint32_t vesc_id(std::uint8_t vesc, VescCommand command) {
  return (static_cast<std::uint32_t>(command) << 8U) | vesc;
}

/// Electrical revolutions a minute; divide by the pole pairs.
struct VescStatus {
  std::int32_t erpm = 0;
  std::int16_t current_da = 0;  ///< tenths of an ampere
  std::int16_t duty_permille = 0;
};

/// Charge in 1e-4 Ah (STATUS_2) or energy in 1e-4 Wh (STATUS_3).
struct VescTotals {
  std::int32_t used = 0;
  std::int32_t charged = 0;
};

struct VescStatus4 {
  std::int16_t transistor_ddegc = 0;  ///< tenths of a degree Celsius
  std::int16_t motor_ddegc = 0;
  std::int16_t input_da = 0;
  std::int16_t position_fiftieth_deg = 0;
};

struct VescStatus5 {
  std::int32_t tachometer = 0;  ///< six counts an electrical revolution; wraps at 2^32
  std::int16_t input_dv = 0;    ///< tenths of a volt
};

struct VescStatus6 {
  std::array<std::int16_t, 3> adc_mv{};
  std::int16_t ppm_permille = 0;
};

/// All: `corrupt` when the frame is too short. STATUS_5 needs six bytes only.
[[nodiscard]] Result<VescStatus> decode_vesc_status(ByteView data);
[[nodiscard]] Result<VescTotals> decode_vesc_totals(ByteView data);
[[nodiscard]] Result<VescStatus4> decode_vesc_status_4(ByteView data);
[[nodiscard]] Result<VescStatus5> decode_vesc_status_5(ByteView data);
[[nodiscard]] Result<VescStatus6> decode_vesc_status_6(ByteView data);

}  // namespace picolo::inline v0
