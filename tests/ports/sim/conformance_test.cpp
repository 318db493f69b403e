// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The simulated port keeps the contracts of hal; and the checks notice a port that does not.

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

#include "picolo/hal/conformance/byte_store.hpp"
#include "picolo/hal/conformance/can_bus.hpp"
#include "picolo/hal/conformance/clock.hpp"
#include "picolo/hal/conformance/serial_port.hpp"
#include "picolo/hal/conformance/watchdog.hpp"
#include "picolo/sim/sim_byte_store.hpp"
#include "picolo/sim/sim_can_bus.hpp"
#include "picolo/sim/sim_clock.hpp"
#include "picolo/sim/sim_serial_port.hpp"
#include "picolo/sim/sim_watchdog.hpp"
#include "support/conformance.hpp"

namespace picolo::sim {
namespace {

struct TimeHarness {
  SimClock sim_clock{Timestamp{5s}};
  SimCycleCounter counter{sim_clock};
  SimClock& clock() { return sim_clock; }
  SimCycleCounter& cycle_counter() { return counter; }
  Timestamp now() { return sim_clock.now(); }
  void wait(Duration duration) { sim_clock.advance(duration); }
};

struct CanHarness : TimeHarness {
  SimCanBus sim_bus{sim_clock};
  SimCanBus& bus() { return sim_bus; }
  bool inject(CanFrame frame) {
    frame.stamp = now();
    sim_bus.deliver(frame);
    return true;
  }
  Result<CanFrame> sent() { return sim_bus.take_sent(now()); }
  void unplug_bus() { sim_bus.set_state(CanState::absent); }
  void plug_bus() { sim_bus.set_state(CanState::active); }
};

struct SerialHarness : TimeHarness {
  SimSerialPort sim_port{sim_clock, 115'200};
  SimSerialPort& port() { return sim_port; }
  bool inject(std::span<const std::uint8_t> bytes) {
    sim_port.deliver(bytes, now());
    return true;
  }
  std::size_t sent(std::span<std::uint8_t> buffer) { return sim_port.take_written(buffer); }
  void unplug() { sim_port.set_connected(false); }
  void plug() { sim_port.set_connected(true); }
};

template <std::size_t Granule>
struct StoreHarness {
  std::array<std::uint8_t, 4 * 256> memory{};
  SimByteStore sim_store{memory, 256, Granule};
  SimByteStore& store() { return sim_store; }
  void reopen() {
    sim_store.cut_power_after(1000, 1);
    sim_store.restore_power();
  }
};

struct DogHarness : TimeHarness {
  SimWatchdog dog{sim_clock, 500ms};
  SimWatchdog& watchdog() { return dog; }
  Duration period() { return dog.period(); }
  bool fired() { return dog.expired(); }
};

TEST(SimConformance, Clock) {
  TimeHarness harness;
  test::expect_conformance(harness, conformance::check_clock<TimeHarness>, 3);
}

TEST(SimConformance, CycleCounter) {
  TimeHarness harness;
  test::expect_conformance(harness, conformance::check_cycle_counter<TimeHarness>, 4);
}

TEST(SimConformance, CanBus) {
  CanHarness harness;
  test::expect_conformance(harness, conformance::check_can_bus<CanHarness>, 34);
}

TEST(SimConformance, SerialPort) {
  SerialHarness harness;
  test::expect_conformance(harness, conformance::check_serial_port<SerialHarness>, 26);
}

TEST(SimConformance, ByteStoreOfEveryGranule) {
  const auto check = [](auto harness) {
    test::expect_conformance(harness, conformance::check_byte_store<decltype(harness)>, 18);
  };
  check(StoreHarness<1>{});
  check(StoreHarness<4>{});
  check(StoreHarness<8>{});
  check(StoreHarness<16>{});
}

TEST(SimConformance, Watchdog) {
  DogHarness harness;
  test::expect_conformance(harness, conformance::check_watchdog<DogHarness>, 3);
}

// Self-test: every check fails for a port that breaks the contract.

struct Reports {
  std::vector<std::string> contracts;
  conformance::Checker checker{[](void* context, const char* contract, const char* cure) {
                                 EXPECT_STRNE(cure, "");
                                 static_cast<Reports*>(context)->contracts.emplace_back(contract);
                               },
                               this};
  [[nodiscard]] bool contain(const std::string& words) const {
    for (const std::string& contract : contracts) {
      if (contract.find(words) != std::string::npos) { return true; }
    }
    return false;
  }
};

/// Swaps two data bytes, forgets the remote flag, returns own frames and takes anything.
struct SloppyCanBus final : CanBus {
  SloppyCanBus(SimCanBus& good, SimClock& clock) : good_(good), clock_(clock) {}
  Result<CanFrame> receive() override {
    if (echo_.length != 0xFF) {
      const CanFrame frame = echo_;
      echo_.length = 0xFF;
      return frame;
    }
    auto frame = good_.receive();
    if (!frame) { return frame; }
    CanFrame wrong = *frame;
    wrong.remote = false;
    std::swap(wrong.data[0], wrong.data[1]);
    wrong.stamp = Timestamp{} - (clock_.now() - Timestamp{});
    return wrong;
  }
  Status transmit(const CanFrame& frame) override {
    echo_ = frame;
    echo_.length = 0;
    static_cast<void>(good_.transmit(frame));
    return Status::ok;
  }
  [[nodiscard]] CanStatus status() const override { return {}; }

 private:
  SimCanBus& good_;
  SimClock& clock_;
  CanFrame echo_{.length = 0xFF};
};

struct SloppyCanHarness : CanHarness {
  SloppyCanBus sloppy{sim_bus, sim_clock};
  CanBus& bus() { return sloppy; }
};

TEST(ConformanceSelfTest, GivenASloppyCanBusThenItsFaultsAreNamed) {
  SloppyCanHarness harness;
  Reports reports;
  conformance::check_can_bus(harness, reports.checker);
  EXPECT_EQ(reports.checker.violated(), reports.contracts.size());
  for (const char* words :
       {"0 to 8 bytes unchanged", "remote requests", "stamps never decrease",
        "on the port's own clock", "CanStatus::received", "CanStatus::transmitted", "own frames",
        "invalid_argument", "answers full", "tx_refused", "disconnected while", "is absent"}) {
    EXPECT_TRUE(reports.contain(words)) << words;
  }
}

/// What a line in canonical mode does: swallows 0x04, turns CR into LF; and a read that answers
/// size 0.
struct CookedSerialPort final : SerialPort {
  explicit CookedSerialPort(SimSerialPort& good) : good_(good) {}
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    const auto read = good_.read(buffer);
    if (!read) { return SerialRead{}; }
    SerialRead result{.last_byte_stamp = Timestamp::max()};
    for (std::size_t i = 0; i < read->size; ++i) {
      if (buffer[i] == 0x04) { continue; }
      buffer[result.size] = buffer[i] == 0x0D ? std::uint8_t{0x0A} : buffer[i];
      ++result.size;
    }
    return result;
  }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    static_cast<void>(good_.write(bytes));
    return bytes.size() + 1;
  }
  [[nodiscard]] std::uint32_t baud() const override { return 0; }
  [[nodiscard]] std::uint32_t lost() const override { return 1; }

 private:
  SimSerialPort& good_;
};

struct CookedSerialHarness : SerialHarness {
  CookedSerialPort cooked{sim_port};
  SerialPort& port() { return cooked; }
};

TEST(ConformanceSelfTest, GivenACookedLineThenItsFaultsAreNamed) {
  CookedSerialHarness harness;
  Reports reports;
  conformance::check_serial_port(harness, reports.checker);
  for (const char* words : {"baud is never 0", "not_ready while no byte", "loses none",
                            "all 256 byte values", "last_byte_stamp", "lost stays 0", "how many",
                            "answers full", "disconnected while", "between 1 byte"}) {
    EXPECT_TRUE(reports.contain(words)) << words;
  }
}

/// Plain RAM: sets bits, erases too much, ignores borders.
struct RamStore final : ByteStore {
  std::array<std::uint8_t, 1024> memory{};
  [[nodiscard]] ByteStoreGeometry geometry() const override {
    return {.size = 1024, .sector = 256, .granule = 4};
  }
  Status read(std::size_t address, std::span<std::uint8_t> bytes) override {
    for (std::size_t i = 0; i < bytes.size(); ++i) { bytes[i] = memory[(address + i) % 1024]; }
    return Status::ok;
  }
  Status program(std::size_t address, std::span<const std::uint8_t> bytes) override {
    for (std::size_t i = 0; i < bytes.size(); ++i) { memory[(address + i) % 1024] = bytes[i]; }
    return Status::ok;
  }
  Status erase(std::size_t) override {
    memory.fill(0xFF);
    return Status::ok;
  }
};

struct RamStoreHarness {
  RamStore ram;
  RamStore& store() { return ram; }
  void reopen() { ram.memory.fill(0xFF); }
};

TEST(ConformanceSelfTest, GivenPlainMemoryThenItsFaultsAreNamed) {
  RamStoreHarness harness;
  Reports reports;
  conformance::check_byte_store(harness, reports.checker);
  for (const char* words : {"neighbouring sector", "never sets a bit", "read beyond the end",
                            "overflows", "program beyond", "erase beyond", "inside of a sector",
                            "off the granules", "part of a granule", "survive a reset"}) {
    EXPECT_TRUE(reports.contain(words)) << words;
  }
}

/// Counts nanoseconds as microseconds, now and then backwards; its cycle counter stands.
struct WildClock final : Clock {
  Timestamp now() override {
    ++calls;
    return base.now() + Duration{calls % 100 == 0 ? -50 : 0} + 999 * (base.now() - Timestamp{});
  }
  SimClock base{};
  std::int64_t calls = 0;
};

struct StoppedCounter final : CycleCounter {
  [[nodiscard]] std::uint32_t cycles() override { return 7; }
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return rate; }
  std::uint32_t rate = 100;
};

struct WildHarness {
  WildClock wild;
  StoppedCounter counter;
  WildClock& clock() { return wild; }
  StoppedCounter& cycle_counter() { return counter; }
  void wait(Duration duration) { wild.base.advance(duration); }
};

TEST(ConformanceSelfTest, GivenAWildClockThenItsFaultsAreNamed) {
  WildHarness harness;
  Reports reports;
  conformance::check_clock(harness, reports.checker);
  conformance::check_cycle_counter(harness, reports.checker);
  EXPECT_TRUE(reports.contain("never steps back"));
  EXPECT_TRUE(reports.contain("does not take 10 s"));
  EXPECT_TRUE(reports.contain("while the processor sleeps"));
  harness.counter.rate = 0;
  conformance::check_cycle_counter(harness, reports.checker);
  EXPECT_TRUE(reports.contain("never 0"));
}

struct SleepingDogHarness : DogHarness {
  bool fired() { return false; }
};

TEST(ConformanceSelfTest, GivenAWatchdogThatSleepsThenItIsNamed) {
  SleepingDogHarness harness;
  Reports reports;
  conformance::check_watchdog(harness, reports.checker);
  EXPECT_TRUE(reports.contain("not stroked fires"));
}

}  // namespace
}  // namespace picolo::sim
