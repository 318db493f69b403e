// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Frames of the table from and to raw values, with counter and CRC in the manner of AUTOSAR's E2E
/// profile 1: CRC-8 with polynomial 0x1D, start and final value 0, over the data identifier (low
/// byte, high byte) and bytes 1 to 7; the counter runs from 0 to 14.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/controller/can_table.hpp"
#include "picolo/core/result.hpp"
#include "picolo/hal/can_bus.hpp"

namespace picolo::inline v0 {

inline constexpr std::uint8_t kCanCounterModulus = 15;

/// Raw values in the order of the message's signals.
struct CanValues {
  std::array<std::int64_t, kMaxCanSignals> raw{};
  std::uint8_t counter = 0;
};

/// Nearest raw value. What is no number, or beyond the range, becomes `not_available`; counts and
/// names are cut to their bits. Cost: O(1), one product in double. Context: any.
[[nodiscard]] std::int64_t to_raw(const CanField& field, double value);
/// The physical value. NaN for `not_available` of a number.
[[nodiscard]] double to_value(const CanField& field, std::int64_t raw);

/// `raw`: one value a signal, cut to their bits. `counter`: modulo 15. Cost: O(signals + 8).
[[nodiscard]] CanFrame encode(const CanLayout& layout, std::uint16_t base_id, std::uint8_t counter,
                              std::span<const std::int64_t> raw);
/// `invalid_argument`: another identifier, a remote or extended frame. `checksum`: length, counter
/// or CRC are wrong.
[[nodiscard]] Result<CanValues> decode(const CanLayout& layout, std::uint16_t base_id,
                                       const CanFrame& frame);
/// The CRC that byte 0 of such a frame must hold.
[[nodiscard]] std::uint8_t frame_crc(const CanLayout& layout, std::span<const std::uint8_t> data);

// The same for a whole message of the table; on targets the layouts are smaller.
[[nodiscard]] inline CanFrame encode(const CanMessage& message, std::uint16_t base_id,
                                     std::uint8_t counter, std::span<const std::int64_t> raw) {
  return encode(layout_of(message), base_id, counter, raw);
}
[[nodiscard]] inline Result<CanValues> decode(const CanMessage& message, std::uint16_t base_id,
                                              const CanFrame& frame) {
  return decode(layout_of(message), base_id, frame);
}

}  // namespace picolo::inline v0
