// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/odrive/odrive_messages.hpp"

namespace picolo::inline v0 {

Result<OdriveHeartbeat> decode_odrive_heartbeat(ByteView data, OdriveFirmware firmware) {
  if (data.size() < 5) { return Status::corrupt; }
  OdriveHeartbeat heartbeat{.axis_error = load_u32_le(data, 0), .axis_state = data[4]};
  if (firmware == OdriveFirmware::up_to_0_5_1 || data.size() < 8) { return heartbeat; }
  if (firmware == OdriveFirmware::from_0_6) {
    heartbeat.procedure_result = data[5];
    heartbeat.trajectory_done = (data[6] & 1U) != 0;
    return heartbeat;
  }
  heartbeat.motor_error = (data[5] & 1U) != 0;
  heartbeat.encoder_error = (data[6] & 1U) != 0;
  heartbeat.controller_error = (data[7] & 1U) != 0;
  heartbeat.trajectory_done = (data[7] & 0x80U) != 0;
  return heartbeat;
}

Result<OdriveFloats> decode_odrive_floats(ByteView data) {
  if (data.size() < 8) { return Status::corrupt; }
  return OdriveFloats{load_u32_le(data, 0), load_u32_le(data, 4)};
}

Result<OdriveCounts> decode_odrive_counts(ByteView data) {
  if (data.size() < 8) { return Status::corrupt; }
  return OdriveCounts{load_i32_le(data, 0), load_i32_le(data, 4)};
}

CanFrame odrive_request(std::uint32_t node, OdriveCommand command) {
  return {.id = odrive_id(node, command), .remote = true};
}

}  // namespace picolo::inline v0
