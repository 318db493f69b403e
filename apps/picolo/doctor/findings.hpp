// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What a look at a bus or a line brought to light, and what it means.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "picolo/hal/can_bus.hpp"

namespace picolo::tool {

struct Finding {
  enum class Level { good, hint, fault };
  Level level = Level::good;
  std::string what;
  std::string cure;
};
using Findings = std::vector<Finding>;

/// Of a CAN bus: what the kernel says, and what was heard in a second after asking the nodes.
struct CanFacts {
  std::string name;
  bool kernel_has_can = true;
  bool exists = true;
  bool may_open = true;
  bool is_can = true;
  bool is_up = true;
  bool is_adapter = false;  ///< SLCAN on a serial line
  bool answers = true;      ///< the adapter answered
  bool is_virtual = false;  ///< vcan or a socket: no bit rate, no acknowledgement
  std::optional<std::uint32_t> bit_rate;
  std::optional<std::uint32_t> restart_ms;
  CanState state = CanState::active;
  bool sent = true;  ///< the requests were taken
  std::uint32_t frames = 0;
  std::uint32_t not_acknowledged = 0;  ///< error frames of that kind
  std::uint32_t protocol_errors = 0;
  std::uint32_t overflows = 0;
  std::uint32_t foreign_talkers = 0;  ///< frames with the controller's own identifiers
  std::string overlap;                ///< identifiers that two users want, in words
  std::string wheels;         ///< driver that listened along; empty for CANopen, whose nodes answer
  std::uint32_t samples = 0;  ///< complete ones that it made
  std::string missing_frames;  ///< identifiers that it waits for and never heard
  std::vector<int> wanted_nodes;
  std::map<int, int> heard_nodes;  ///< node to its last NMT state; -1: it only answered or sent
};
[[nodiscard]] Findings judge(const CanFacts& facts);

/// So many packets of a device are no accident.
inline constexpr std::uint32_t kFewPackets = 3;

/// One try to read a device at a rate.
struct SerialTrial {
  std::uint32_t baud = 0;
  double seconds = 0.5;
  bool possible = true;  ///< the adapter can do it
  std::uint32_t bytes = 0;
  std::uint32_t packets = 0;
  std::uint32_t bad_checksums = 0;
};

struct SerialFacts {
  std::string path;
  std::string device;  ///< what is expected there, for people
  bool exists = true;
  bool may_open = true;
  bool is_busy = false;
  bool is_terminal = true;
  std::vector<std::uint32_t> bauds;  ///< that picolo run would try
  SerialTrial trial;                 ///< at the first of them
  std::vector<SerialTrial> others;
  std::optional<int> latency_ms;  ///< timer of a USB adapter
  std::string other_readers;      ///< programs that have the line open as well
};
[[nodiscard]] Findings judge(const SerialFacts& facts);

[[nodiscard]] bool any_fault(const Findings& findings);

}  // namespace picolo::tool
