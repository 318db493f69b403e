// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The Linux port keeps the contracts of hal, on a socket pair, a pseudo-terminal and a file.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "can_pair.hpp"
#include "picolo/hal/conformance/byte_store.hpp"
#include "picolo/hal/conformance/can_bus.hpp"
#include "picolo/hal/conformance/clock.hpp"
#include "picolo/hal/conformance/serial_port.hpp"
#include "picolo/linux/file_byte_store.hpp"
#include "picolo/linux/linux_clock.hpp"
#include "picolo/linux/socket_can_bus.hpp"
#include "picolo/linux/termios_serial_port.hpp"
#include "pseudo_terminal.hpp"
#include "support/conformance.hpp"

namespace picolo {
namespace {

struct TimeHarness {
  LinuxClock linux_clock;
  LinuxCycleCounter counter;
  LinuxClock& clock() { return linux_clock; }
  LinuxCycleCounter& cycle_counter() { return counter; }
  Timestamp now() { return linux_clock.now(); }
  void wait(Duration duration) { EXPECT_EQ(sleep_until(now() + duration), Status::ok); }
};

struct CanHarness : TimeHarness {
  std::unique_ptr<test::CanPair> pair;
  SocketCanBus can{linux_clock};
  CanHarness() { plug_bus(); }
  SocketCanBus& bus() { return can; }
  bool inject(const CanFrame& frame) { return pair->send(frame); }
  Result<CanFrame> sent() { return pair->receive(); }
  // Nothing in a socket pair takes time.
  void wait(Duration duration) { TimeHarness::wait(std::min<Duration>(duration, 1ms)); }
  void unplug_bus() { pair->close(); }
  void plug_bus() {
    pair = std::make_unique<test::CanPair>();
    EXPECT_EQ(can.adopt(pair->take_port()), Status::ok);
  }
};

struct SerialHarness : TimeHarness {
  test::PseudoTerminal terminal;
  TermiosSerialPort serial{linux_clock, {.baud = 230'400, .retry_period = 1ms}};
  SerialHarness() { EXPECT_EQ(serial.open(terminal.path().c_str()), Status::ok); }
  TermiosSerialPort& port() { return serial; }
  bool inject(std::span<const std::uint8_t> bytes) { return terminal.send(bytes); }
  std::size_t sent(std::span<std::uint8_t> buffer) { return terminal.receive(buffer); }
  // A pseudo-terminal has no baud rate; its worker needs a moment to carry bytes over.
  void wait(Duration duration) { TimeHarness::wait(std::min<Duration>(duration, 20ms)); }
  void unplug() { terminal.unplug(); }
  void plug() { terminal.plug(); }
};

template <std::size_t Granule>
struct StoreHarness {
  test::TemporaryFolder folder;
  FileByteStoreConfig config{.geometry = {.size = 4096, .sector = 1024, .granule = Granule},
                             .durable = false};
  std::unique_ptr<FileByteStore> file;
  StoreHarness() { reopen(); }
  FileByteStore& store() { return *file; }
  void reopen() {
    file.reset();
    file = std::make_unique<FileByteStore>(config);
    EXPECT_EQ(file->open((folder.path() / "store").c_str()), Status::ok);
  }
};

TEST(LinuxConformance, Clock) {
  TimeHarness harness;
  test::expect_conformance(harness, conformance::check_clock<TimeHarness>, 3);
}

TEST(LinuxConformance, CycleCounter) {
  TimeHarness harness;
  test::expect_conformance(harness, conformance::check_cycle_counter<TimeHarness>, 4);
}

TEST(LinuxConformance, CanBus) {
  CanHarness harness;
  test::expect_conformance(harness, conformance::check_can_bus<CanHarness>, 34);
}

TEST(LinuxConformance, SerialPort) {
  SerialHarness harness;
  test::expect_conformance(harness, conformance::check_serial_port<SerialHarness>, 26);
}

TEST(LinuxConformance, ByteStoreOfEveryGranule) {
  StoreHarness<1> bytes;
  test::expect_conformance(bytes, conformance::check_byte_store<StoreHarness<1>>, 18);
  StoreHarness<8> words;
  test::expect_conformance(words, conformance::check_byte_store<StoreHarness<8>>, 20);
}

}  // namespace
}  // namespace picolo
