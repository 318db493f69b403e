// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Frames as a raw CAN socket carries them, for the nodes that tests play: written apart from the
/// port, so that a mistake of the port shows.
#pragma once

#include <linux/can.h>
#include <linux/can/error.h>

#include <algorithm>
#include <cstdint>

#include "picolo/hal/can_bus.hpp"

namespace picolo::test {

inline can_frame raw_frame(const CanFrame& frame) {
  can_frame raw{};
  raw.can_id = frame.id | (frame.extended ? CAN_EFF_FLAG : 0U) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.can_dlc = frame.length;
  std::copy(frame.data.begin(), frame.data.end(), std::begin(raw.data));
  return raw;
}

/// An error frame as the kernel makes it.
inline can_frame raw_error(std::uint32_t kind, std::uint8_t controller) {
  can_frame raw{};
  raw.can_id = CAN_ERR_FLAG | kind;
  raw.can_dlc = CAN_ERR_DLC;
  raw.data[1] = controller;
  return raw;
}

inline CanFrame frame_of(const can_frame& raw) {
  CanFrame frame;
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.id = raw.can_id & (frame.extended ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.length = raw.can_dlc;
  std::copy(std::begin(raw.data), std::end(raw.data), frame.data.begin());
  return frame;
}

}  // namespace picolo::test
