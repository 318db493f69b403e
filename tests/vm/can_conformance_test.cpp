// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The contracts of CanBus, on true interfaces.

#include <optional>

#include "can_bench.hpp"
#include "picolo/hal/conformance/can_bus.hpp"
#include "support/conformance.hpp"
#include "wirings.hpp"

namespace picolo::test {
namespace {

/// A short queue before the interface, so that it can be full.
struct CanHarness {
  explicit CanHarness(const Wiring& w) : wiring(w) {
    shell("/sbin/tc qdisc replace dev " + wiring.port + " root netem delay 5ms limit 50");
    EXPECT_EQ(port.open(wiring.port.c_str()), Status::ok);
  }
  ~CanHarness() { shell("/sbin/tc qdisc del dev " + wiring.port + " root"); }
  CanBus& bus() { return port; }
  bool inject(const CanFrame& frame) {
    if (wiring.port == wiring.other) { wait(0ms); }  // the same queue
    return other->send(frame);
  }
  Result<CanFrame> sent() { return other->receive(20ms); }
  [[nodiscard]] Timestamp now() { return clock.now(); }
  void wait(Duration duration) { static_cast<void>(sleep_until(clock.now() + duration + 20ms)); }
  void unplug_bus() { shell("/sbin/ip link set " + wiring.port + " down"); }
  void plug_bus() {
    shell("/sbin/ip link set " + wiring.port + " up");
    other.emplace(wiring.other);  // its socket holds an error of the time without the interface
  }

  const Wiring& wiring;
  LinuxClock clock;
  SocketCanBus port{clock};
  std::optional<CanNode> other{wiring.other};
};

/// QEMU's controller mistakes the length of a remote frame for bytes in its FIFO, for ever after.
struct EmulatedHarness : CanHarness {
  using CanHarness::CanHarness;
  static constexpr std::uint8_t kRemoteLength = 0;
};

TEST(VcanContracts, Hold) {
  const Wiring wiring = vcan();
  CanHarness harness{wiring};
  expect_conformance(harness, conformance::check_can_bus<CanHarness>, 34);
}

TEST(Sja1000Contracts, Hold) {
  const Wiring wiring = controllers();
  EmulatedHarness harness{wiring};
  expect_conformance(harness, conformance::check_can_bus<EmulatedHarness>, 34);
}

}  // namespace
}  // namespace picolo::test
