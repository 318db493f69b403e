// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The port on one interface, and the other node of its bus on the same or another interface.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "can_node.hpp"
#include "picolo/linux/linux_clock.hpp"
#include "picolo/linux/socket_can_bus.hpp"
#include "shell.hpp"

namespace picolo::test {

/// Two interfaces that share a bus, and how the port's one is taken away for good and brought back.
struct Wiring {
  const char* name;
  std::string port;
  std::string other;
  std::string remove;
  std::string make;
};

inline void PrintTo(const Wiring& wiring, std::ostream* out) {
  *out << wiring.name;
}

class CanPort : public ::testing::TestWithParam<Wiring> {
 protected:
  void open(std::span<const CanFilter> filters = {}) {
    ASSERT_EQ(bus.open(GetParam().port.c_str(), filters), Status::ok);
  }
  /// All frames up to the one with this identifier, which ends a test's traffic.
  std::vector<CanFrame> frames_until(std::uint32_t id) {
    std::vector<CanFrame> frames;
    for (auto frame = next(bus); frame; frame = next(bus)) {
      if (frame->id == id) { return frames; }
      frames.push_back(*frame);
    }
    ADD_FAILURE() << "the last frame did not arrive";
    return frames;
  }
  void set_link(const char* state) { shell("/sbin/ip link set " + GetParam().port + " " + state); }

  LinuxClock clock;
  CanNode other{GetParam().other};
  SocketCanBus bus{clock};
};

}  // namespace picolo::test
