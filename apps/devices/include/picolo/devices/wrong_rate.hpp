// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A serial line whose two ends have different rates.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace picolo::inline v0::devices {

/// What a receiver of 8N1 makes of these bytes: it samples bits at its own times. The line rests
/// before and behind them. Precondition: both rates above 0.
[[nodiscard]] std::vector<std::uint8_t> received_at(std::span<const std::uint8_t> sent,
                                                    std::uint32_t sender_baud,
                                                    std::uint32_t receiver_baud);

}  // namespace picolo::inline v0::devices
