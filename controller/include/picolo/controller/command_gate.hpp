// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Commands from the bus: which of them may act, and how a commander makes them.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/controller/can_codec.hpp"
#include "picolo/controller/frames_out.hpp"
#include "picolo/core/result.hpp"
#include "picolo/geometry/pose2.hpp"

namespace picolo::inline v0 {

struct Command {
  CommandKind kind = CommandKind::set_pose;
  std::uint8_t counter = 0;
  std::uint8_t tick = 0;    ///< the newest one that the commander saw in PicoloHealth
  Pose2d map_T_base{};      ///< set_pose
  std::uint8_t detail = 0;  ///< mode, slot or procedure
  std::uint16_t index = 0;  ///< read_events
};

/// The frame of a command, for commanders and tests.
[[nodiscard]] CanFrame encode_command(std::uint16_t base_id, const Command& command);

/// Never reset.
struct CommandCounters {
  std::uint32_t accepted = 0;
  std::uint32_t corrupt = 0;   ///< wrong CRC, counter, length or width
  std::uint32_t repeated = 0;  ///< counter of the command before
  std::uint32_t stale = 0;     ///< tick too old, or out of order
  std::uint32_t refused = 0;   ///< sound, but it could not be done
};

/// A command frame and what the gate says of it: `done` means that it may act.
struct Receipt {
  Command command{};
  CommandResult verdict = CommandResult::done;
};

/// A command passes when its CRC is right, its tick at most two older than now (0.5 to 0.75 s), and
/// its counter ahead of the last one of its kind; after a second without commands any counter is.
/// This guards against accidents (a replayed log, a stuck sender, a device that uses our
/// identifiers), not against somebody who wants to break in: CAN knows no secrets.
/// Cost: O(1). Context: cycle only.
class CommandGate {
 public:
  explicit CommandGate(std::uint16_t base_id) : base_id_(base_id) {}

  /// `not_ready`: not the identifier of a command.
  [[nodiscard]] Result<Receipt> check(const CanFrame& frame, Timestamp now);
  void count_refused() { ++counters_.refused; }
  [[nodiscard]] const CommandCounters& counters() const { return counters_; }

 private:
  struct Last {
    Timestamp stamp{};
    std::uint8_t counter = 0;
    bool any = false;
  };
  [[nodiscard]] CommandResult judge(const Command& command, Timestamp now) const;

  std::uint16_t base_id_;
  std::array<Last, kCommandKinds> last_{};
  CommandCounters counters_{};
};

}  // namespace picolo::inline v0
