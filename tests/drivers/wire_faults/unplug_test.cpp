// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Unplugged in the middle of a packet and plugged in again: every shell says so and recovers.

#include <gtest/gtest.h>

#include <array>

#include "picolo/drivers/bno08x/bno08x_rvc.hpp"
#include "picolo/drivers/rplidar/rplidar.hpp"
#include "picolo/drivers/scip/scip.hpp"
#include "picolo/drivers/vectornav/vectornav.hpp"
#include "picolo/drivers/xsens/xsens.hpp"
#include "picolo/drivers/ydlidar/ydlidar.hpp"
#include "support/fake_serial_port.hpp"
#include "wires.hpp"

namespace picolo::test {
namespace {

Wire wire_named(const std::string& name) {
  for (const Wire& wire : all_wires()) {
    if (wire.name == name) { return wire; }
  }
  ADD_FAILURE() << "no wire " << name;
  return {};
}

template <typename Shell>
void unplug(const std::string& name, const typename Shell::Config& config) {
  SCOPED_TRACE(name);
  const Wire wire = wire_named(name);
  FakeSerialPort port{250'000};
  Shell shell{port, config};
  std::array<typename Shell::Sample, 48> samples{};
  Timestamp now{1s};
  auto drain = [&] {
    std::size_t total = 0;
    for (auto n = shell.poll(100'000, samples); n; n = shell.poll(100'000, samples)) {
      total += *n;
    }
    return total;
  };
  auto send = [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = first; i < first + count; ++i) {
      now += 10ms;
      port.arrives(now, wire.packet(i));
    }
  };
  send(0, 12);
  const std::size_t before = drain();
  EXPECT_GT(before, 0U);
  Bytes half = wire.packet(12);
  half.resize(half.size() / 2);
  port.arrives(now += 10ms, half);
  drain();
  port.disconnect();
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(shell.poll(4096, samples).status(), Status::disconnected);
    static_cast<void>(shell.service(now));
  }
  port.reconnect();
  send(20, 12);
  EXPECT_GE(drain() + before / 4, before);
  EXPECT_LE(shell.counters().bad_checksums, 1U);
}

TEST(Unplug, GivenEveryShellThenItSaysSoAndCarriesOnWithTheNextPacket) {
  unplug<Rplidar>("rplidar 0x81", {.active = false});
  unplug<Rplidar>("rplidar 0x85", {.mode = RplidarMode::dense, .active = false});
  unplug<Scip>("scip", {.active = false});
  unplug<Ydlidar>("ydlidar", {.active = false});
  unplug<Bno08xRvc>("bno08x-rvc", {});
  unplug<Xsens>("xsens", {.active = false});
  unplug<Vectornav>("vectornav bin", {});
}

}  // namespace
}  // namespace picolo::test
