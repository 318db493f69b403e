// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/canopen/messages.hpp"

#include "picolo/drivers/canopen/cob_id.hpp"

namespace picolo::inline v0::canopen {

CanFrame nmt_frame(NmtCommand command, std::uint8_t node) {
  CanFrame frame{.id = kNmtId, .length = 2};
  frame.data[0] = static_cast<std::uint8_t>(command);
  frame.data[1] = node;
  return frame;
}

CanFrame sync_frame() {
  return {.id = kSyncId, .length = 0};
}

CanFrame sync_frame(std::uint8_t counter) {
  CanFrame frame{.id = kSyncId, .length = 1};
  frame.data[0] = counter;
  return frame;
}

Result<NmtState> decode_heartbeat(ByteView data) {
  if (data.empty()) { return Status::corrupt; }
  const auto state = static_cast<NmtState>(data[0] & 0x7FU);
  switch (state) {
    case NmtState::boot_up:
    case NmtState::stopped:
    case NmtState::operational:
    case NmtState::pre_operational: return state;
  }
  return Status::corrupt;
}

Result<Emergency> decode_emergency(ByteView data) {
  if (data.size() < 3) { return Status::corrupt; }
  Emergency emergency{.code = load_u16_le(data, 0), .error_register = data[2]};
  for (std::size_t i = 3; i < data.size() && i < 8; ++i) { emergency.vendor[i - 3] = data[i]; }
  return emergency;
}

}  // namespace picolo::inline v0::canopen
