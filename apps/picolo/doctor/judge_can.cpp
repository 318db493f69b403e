// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "doctor/findings.hpp"

namespace picolo::tool {
namespace {

using Level = Finding::Level;

constexpr std::uint32_t kManyErrors = 5;

void judge_nodes(const CanFacts& facts, Findings& findings) {
  std::string others;
  for (const auto& [node, state] : facts.heard_nodes) {
    others += fmt::format("{}{}", others.empty() ? "" : ", ", node);
  }
  for (const int node : facts.wanted_nodes) {
    const auto heard = facts.heard_nodes.find(node);
    if (heard == facts.heard_nodes.end()) {
      findings.push_back(
          {Level::fault,
           fmt::format("no node {} on the bus{}", node,
                       others.empty() ? ", nor any other" : "; heard: node " + others),
           "is it powered and wired? Compare its number (DIP switch, object 0x2000 or the maker's "
           "tool) with [wheels] left_id and right_id"});
      continue;
    }
    if (heard->second == 0x04) {
      findings.push_back({Level::hint, fmt::format("node {} is stopped", node),
                          "picolo run starts it; if not, another master stops it again"});
    } else {
      findings.push_back({Level::good, fmt::format("node {} is there", node), ""});
    }
  }
}

/// Wheels that cannot be asked: what their driver made of the frames that came by itself.
void judge_wheels(const CanFacts& facts, Findings& findings) {
  if (facts.wheels.empty()) { return; }
  if (facts.samples > 0) {
    findings.push_back({Level::good,
                        fmt::format("{} samples of the wheels ({})", facts.samples, facts.wheels),
                        ""});
    return;
  }
  const std::string what = facts.missing_frames.empty()
                               ? "their frames come, but make no sample"
                               : "no frame with the identifiers " + facts.missing_frames + " came";
  findings.push_back(
      {Level::fault, fmt::format("wheels ({}): {}", facts.wheels, what),
       "check left_id and right_id in [wheels], and that the drives send by themselves (ODrive: "
       "encoder_msg_rate_ms; VESC: CAN status messages 1 to 5; DBC: the message's cycle)"});
}

/// True when it makes no sense to look further.
bool judge_interface(const CanFacts& facts, Findings& findings) {
  if (!facts.kernel_has_can) {
    findings.push_back({Level::fault, "this kernel has no CAN",
                        "sudo modprobe can can-raw (and the driver of the adapter, or vcan); in a "
                        "container load them on its host"});
  } else if (!facts.exists && facts.is_adapter) {
    findings.push_back({Level::fault, "there is no such line",
                        "is the adapter plugged in? ls /dev/serial/by-id lists them"});
  } else if (!facts.answers) {
    findings.push_back(
        {Level::fault, "nobody answers on this line",
         "an adapter behind a UART has one rate: try slcan:TTY,500000,115200. Is its firmware "
         "SLCAN? One that shows up as an interface (ip -br link) is used by that name"});
  } else if (!facts.exists) {
    findings.push_back(
        {Level::fault, "there is no such interface",
         "is the adapter plugged in? ip -br link lists all; for a test: sudo ip link "
         "add " +
             facts.name + " type vcan"});
  } else if (!facts.is_can) {
    findings.push_back({Level::fault, "is a network interface, but not of CAN",
                        "ip -br link show type can lists those of CAN"});
  } else if (!facts.may_open) {
    findings.push_back(
        {Level::fault, "you may not open it", "run as root, or give the program CAP_NET_RAW"});
  } else if (!facts.is_up) {
    findings.push_back(
        {Level::fault, "the interface is down",
         facts.is_virtual ? "sudo ip link set " + facts.name + " up"
                          : fmt::format("sudo ip link set {} up type can bitrate 500000 restart-ms "
                                        "100 (with the bus's bit rate)",
                                        facts.name)});
  }
  return any_fault(findings);
}

void judge_bus(const CanFacts& facts, Findings& findings) {
  const std::string rate =
      facts.bit_rate ? fmt::format(" (now {} bit/s)", *facts.bit_rate) : std::string{};
  if (facts.state == CanState::bus_off) {
    findings.push_back(
        {Level::fault, "bus-off: the controller gave up after too many errors",
         fmt::format("check bit rate{}, the two 120 ohm terminators and CAN-H/CAN-L; then sudo ip "
                     "link set {} type can restart, and restart-ms 100 for good",
                     rate, facts.name)});
  }
  const bool errors = facts.protocol_errors >= kManyErrors;
  if (errors && facts.protocol_errors > facts.frames) {
    findings.push_back({Level::fault,
                        fmt::format("{} errors and {} frames in a second: wrong bit rate, or bad "
                                    "wiring",
                                    facts.protocol_errors, facts.frames),
                        fmt::format("set the bit rate of the other nodes{}: sudo ip link set {} "
                                    "down; sudo ip link set {} up type can bitrate RATE. With the "
                                    "right rate: check terminators and CAN-H/CAN-L",
                                    rate, facts.name, facts.name)});
  } else if (errors) {
    findings.push_back({Level::hint, fmt::format("{} errors in a second", facts.protocol_errors),
                        "check terminators, stubs and shielding"});
  }
  if (facts.not_acknowledged > 0 && facts.frames == 0) {
    findings.push_back({Level::fault, "nobody acknowledges what is sent",
                        "the other nodes are off, at another bit rate" + rate +
                            ", or the cable is open: check power, CAN-H/CAN-L and terminators"});
  }
  if (!facts.sent && facts.state != CanState::bus_off && facts.not_acknowledged == 0) {
    findings.push_back({Level::fault, "the send queue is full and does not empty",
                        "nobody acknowledges: check power, wiring and bit rate" + rate});
  }
  if (facts.overflows > 0) {
    findings.push_back({Level::hint, "the controller lost frames before the kernel read them",
                        "lower the load of the bus, or take another adapter"});
  }
  if (facts.foreign_talkers > 0) {
    findings.push_back(
        {Level::hint, fmt::format("{} frames with picolo's own identifiers", facts.foreign_talkers),
         "is picolo already running on this bus? Otherwise choose another [can] base_id"});
  }
  if (facts.restart_ms && *facts.restart_ms == 0 && !facts.is_virtual) {
    findings.push_back({Level::hint, "it stays off after bus-off (restart-ms is 0)",
                        fmt::format("sudo ip link set {} type can restart-ms 100", facts.name)});
  }
}

}  // namespace

bool any_fault(const Findings& findings) {
  for (const Finding& finding : findings) {
    if (finding.level == Level::fault) { return true; }
  }
  return false;
}

Findings judge(const CanFacts& facts) {
  Findings findings;
  if (!facts.overlap.empty()) {
    findings.push_back({Level::fault, facts.overlap, "or set another [can] base_id"});
  }
  if (judge_interface(facts, findings)) { return findings; }
  judge_bus(facts, findings);
  if (any_fault(findings)) { return findings; }  // what follows is only their consequence
  findings.push_back(
      {Level::good, fmt::format("the bus works, {} frames in a second", facts.frames), ""});
  judge_nodes(facts, findings);
  judge_wheels(facts, findings);
  return findings;
}

}  // namespace picolo::tool
