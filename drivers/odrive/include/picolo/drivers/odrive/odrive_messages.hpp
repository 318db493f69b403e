// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// ODrive CANSimple: identifier = node << 5 | command, little-endian. Pure codec.
#pragma once

#include <cstdint>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"
#include "picolo/hal/can_bus.hpp"

namespace picolo::inline v0 {

enum class OdriveCommand : std::uint8_t {
  heartbeat = 0x01,
  motor_error = 0x03,
  encoder_error = 0x04,
  encoder_estimates = 0x09,
  encoder_count = 0x0A,
  iq = 0x14,
  bus = 0x17,
  controller_error = 0x1D,
};

inline constexpr std::uint8_t kOdriveMaxNode = 63;

[[nodiscard]] constexpr std::uint32_t odrive_id(std::uint32_t node, OdriveCommand command) {
  return (node << 5U) | static_cast<std::uint32_t>(command);
}

/// What the last bytes of a heartbeat mean changed twice.
enum class OdriveFirmware : std::uint8_t {
  up_to_0_5_1,  ///< the state has 32 bits, and nothing follows
  from_0_5_4,   ///< bits for errors of motor, encoder, controller
  from_0_6,     ///< result of the last procedure
};

struct OdriveHeartbeat {
  std::uint32_t axis_error = 0;
  std::uint8_t axis_state = 0;  ///< 1 idle, 8 closed loop
  bool motor_error = false;
  bool encoder_error = false;
  bool controller_error = false;
  bool trajectory_done = false;
  std::uint8_t procedure_result = 0;
  /// An axis can be faulted while axis_error is 0.
  [[nodiscard]] constexpr bool faulted() const {
    return axis_error != 0 || motor_error || encoder_error || controller_error;
  }
};

/// As on the wire; `float_from_bits` or `scaled_integer` make numbers of them.
struct OdriveFloats {
  std::uint32_t first_bits = 0;   ///< position in turns; bus voltage; Iq set point
  std::uint32_t second_bits = 0;  ///< velocity in turns a second; bus current; Iq measured
};

struct OdriveCounts {
  std::int32_t shadow_count = 0;  ///< wraps at 2^32
  std::int32_t count_in_cpr = 0;
};

/// All: `corrupt` when the frame is too short.
[[nodiscard]] Result<OdriveHeartbeat> decode_odrive_heartbeat(ByteView data,
                                                              OdriveFirmware firmware);
[[nodiscard]] Result<OdriveFloats> decode_odrive_floats(ByteView data);
[[nodiscard]] Result<OdriveCounts> decode_odrive_counts(ByteView data);
/// Asks for a message that is not sent by itself (firmware 0.5).
[[nodiscard]] CanFrame odrive_request(std::uint32_t node, OdriveCommand command);

}  // namespace picolo::inline v0
