// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/can_filter.hpp"

namespace picolo::inline v0::zcu102 {

/// A frame as the controller's FIFOs hold it (UG1085, table "CAN Message Format").
struct CanWords {
  std::uint32_t id = 0;
  std::uint32_t length = 0;
  std::uint32_t data_high = 0;  ///< bytes 0 to 3, the first in the highest bits
  std::uint32_t data_low = 0;
};

/// An acceptance filter: bits that are set in `mask` must agree with `id`.
struct FilterWords {
  std::uint32_t mask = 0;
  std::uint32_t id = 0;
};

[[nodiscard]] CanWords to_words(const CanFrame& frame);
[[nodiscard]] CanFrame to_frame(const CanWords& words);
/// Data frames only, as CanFilter says.
[[nodiscard]] FilterWords to_words(const CanFilter& filter);

}  // namespace picolo::inline v0::zcu102
