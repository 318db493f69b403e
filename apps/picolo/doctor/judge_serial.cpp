// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "doctor/findings.hpp"

namespace picolo::tool {
namespace {

using Level = Finding::Level;

/// True when it makes no sense to look further.
bool judge_access(const SerialFacts& facts, Findings& findings) {
  if (!facts.exists) {
    findings.push_back({Level::fault, "does not exist",
                        "is the adapter plugged in? ls -l /dev/serial/by-id lists those that are, "
                        "under names that stay"});
  } else if (!facts.may_open) {
    findings.push_back(
        {Level::fault, "you may not open it", "sudo usermod -aG dialout $USER, then log in again"});
  } else if (facts.is_busy) {
    findings.push_back({Level::fault, "another program holds it" + facts.other_readers,
                        "end that program (ModemManager and gpsd take lines unasked)"});
  } else if (!facts.is_terminal) {
    findings.push_back({Level::fault, "is no serial line", "give a device such as /dev/ttyUSB0"});
  } else if (!facts.trial.possible) {
    findings.push_back({Level::fault,
                        fmt::format("the adapter cannot do {} baud", facts.trial.baud),
                        "take another adapter, or set device and [lidar] or [imu] baud lower"});
  }
  return any_fault(findings);
}

const SerialTrial* best_other(const SerialFacts& facts) {
  const SerialTrial* best = nullptr;
  for (const SerialTrial& trial : facts.others) {
    const bool sound = trial.packets >= kFewPackets && trial.packets > trial.bad_checksums;
    if (sound && (best == nullptr || trial.packets > best->packets)) { best = &trial; }
  }
  return best;
}

void judge_bytes(const SerialFacts& facts, Findings& findings) {
  const SerialTrial& trial = facts.trial;
  if (trial.packets >= kFewPackets) {
    if (trial.bad_checksums * 10 > trial.packets) {
      findings.push_back({Level::fault,
                          fmt::format("checksum storm: {} of {} packets are damaged",
                                      trial.bad_checksums, trial.bad_checksums + trial.packets),
                          "a second reader of the line" + facts.other_readers +
                              ", a bad cable or ground, or a baud rate a few percent off"});
      return;
    }
    findings.push_back(
        {Level::good,
         fmt::format("{} sound packets of the {} in {:.1f} s, {} damaged", trial.packets,
                     facts.device, trial.seconds, trial.bad_checksums),
         ""});
    return;
  }
  if (const SerialTrial* other = best_other(facts)) {
    if (std::find(facts.bauds.begin(), facts.bauds.end(), other->baud) != facts.bauds.end()) {
      findings.push_back(
          {Level::good,
           fmt::format("{} sound packets of the {} at {} baud, which picolo run finds by itself",
                       other->packets, facts.device, other->baud),
           ""});
      return;
    }
    findings.push_back(
        {Level::fault,
         fmt::format("wrong baud rate: nothing sound at {}, but at {}", trial.baud, other->baud),
         fmt::format("set baud = {} in [{}] of the configuration", other->baud,
                     facts.device == "IMU" ? "imu" : "lidar")});
    return;
  }
  bool any_bytes = trial.bytes > 0;
  for (const SerialTrial& other : facts.others) { any_bytes = any_bytes || other.bytes > 0; }
  if (!any_bytes) {
    findings.push_back({Level::fault, "no bytes come",
                        "is the device powered, does it turn? Are TX and RX exchanged?"});
    return;
  }
  findings.push_back(
      {Level::fault,
       fmt::format("bytes come, but no packets of the {} at any rate tried", facts.device),
       "is it this device on this line? Lidar and IMU exchanged? A line that is "
       "inverted (RS-232 against TTL) looks like this too"});
}

}  // namespace

Findings judge(const SerialFacts& facts) {
  Findings findings;
  if (judge_access(facts, findings)) { return findings; }
  judge_bytes(facts, findings);
  if (facts.latency_ms && *facts.latency_ms > 2) {
    const std::string name = facts.path.substr(facts.path.rfind('/') + 1);
    findings.push_back(
        {Level::hint, fmt::format("the adapter holds bytes back for {} ms", *facts.latency_ms),
         fmt::format("echo 1 | sudo tee /sys/bus/usb-serial/devices/{}/latency_timer", name)});
  }
  return findings;
}

}  // namespace picolo::tool
