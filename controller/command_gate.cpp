// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/command_gate.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::uint8_t kOldestTick = 2;
constexpr Duration kMemory = 1s;            // longer than a tick lives
constexpr std::uint8_t kFurthestAhead = 7;  // half of the counter's circle

constexpr std::array<CanLayout, kCommandKinds> kCommands{
    can_layout::kSetPose,   can_layout::kSetMode,          can_layout::kSaveMap,
    can_layout::kLoadMap,   can_layout::kStartCalibration, can_layout::kAbortCalibration,
    can_layout::kReadEvents};

Command to_command(CommandKind kind, const CanValues& values) {
  const CanLayout& layout = kCommands[static_cast<std::size_t>(kind)];
  Command command{.kind = kind, .counter = values.counter};
  command.tick = static_cast<std::uint8_t>(values.raw[0]);
  if (kind == CommandKind::set_pose) {
    command.map_T_base = {to_value(layout.fields[1], values.raw[1]),
                          to_value(layout.fields[2], values.raw[2]),
                          to_value(layout.fields[3], values.raw[3])};
  } else if (kind == CommandKind::read_events) {
    command.index = static_cast<std::uint16_t>(values.raw[1]);
  } else {
    command.detail = static_cast<std::uint8_t>(values.raw[1]);
  }
  return command;
}

}  // namespace

CanFrame encode_command(std::uint16_t base_id, const Command& command) {
  const CanLayout& layout = kCommands[static_cast<std::size_t>(command.kind)];
  std::array<std::int64_t, kMaxCanSignals> raw{command.tick};
  if (command.kind == CommandKind::set_pose) {
    raw[1] = to_raw(layout.fields[1], command.map_T_base.x_m);
    raw[2] = to_raw(layout.fields[2], command.map_T_base.y_m);
    raw[3] = to_raw(layout.fields[3], command.map_T_base.theta_rad);
  } else {
    raw[1] = command.kind == CommandKind::read_events ? command.index : command.detail;
  }
  return encode(layout, base_id, command.counter, raw);
}

Result<Receipt> CommandGate::check(const CanFrame& frame, Timestamp now) {
  for (std::size_t i = 0; i < kCommandKinds; ++i) {
    const auto kind = static_cast<CommandKind>(i);
    const auto id = static_cast<std::uint32_t>(base_id_ + kCommands[i].offset);
    if (frame.id != id || frame.extended) { continue; }
    const Result<CanValues> values = decode(kCommands[i], base_id_, frame);
    if (!values) {
      ++counters_.corrupt;
      return Receipt{{.kind = kind, .counter = static_cast<std::uint8_t>(frame.data[1] & 0xFU)},
                     CommandResult::corrupt};
    }
    const Command command = to_command(kind, *values);
    const CommandResult verdict = judge(command, now);
    if (verdict == CommandResult::done) {
      ++counters_.accepted;
      last_[i] = {.stamp = now, .counter = command.counter, .any = true};
    } else {
      ++(verdict == CommandResult::repeated ? counters_.repeated : counters_.stale);
    }
    return Receipt{command, verdict};
  }
  return Status::not_ready;
}

CommandResult CommandGate::judge(const Command& command, Timestamp now) const {
  const Last& last = last_[static_cast<std::size_t>(command.kind)];
  const bool remembered = last.any && now - last.stamp < kMemory;
  const auto ahead = static_cast<std::uint8_t>(
      (command.counter + kCanCounterModulus - last.counter) % kCanCounterModulus);
  if (remembered && ahead == 0) { return CommandResult::repeated; }
  const auto age = static_cast<std::uint8_t>(can_tick(now) - command.tick);
  const bool out_of_order = remembered && ahead > kFurthestAhead;
  return age > kOldestTick || out_of_order ? CommandResult::stale : CommandResult::done;
}

}  // namespace picolo::inline v0
