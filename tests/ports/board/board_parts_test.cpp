// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "picolo/board/counter_time.hpp"
#include "picolo/board/memory_byte_store.hpp"
#include "picolo/board/serial_rings.hpp"
#include "picolo/hal/conformance/byte_store.hpp"
#include "picolo/hal/conformance/serial_port.hpp"
#include "support/conformance.hpp"
#include "support/slow_flash.hpp"

namespace picolo::board {
namespace {

TEST(CounterTime, NoticesEveryWrapAndLosesNoTick) {
  CounterTime time{25, 0xFFFF'FF00U};
  std::uint64_t ticks = 0;
  Timestamp last{};
  for (std::uint32_t step = 1; ticks < (std::uint64_t{3} << 32); step = step * 3 + 1) {
    const std::uint32_t bounded = step % 0xF000'0000U;
    ticks += bounded;
    const Timestamp now = time.at(0xFFFF'FF00U + static_cast<std::uint32_t>(ticks));
    EXPECT_GE(now, last);
    EXPECT_EQ(now.time_since_epoch().count(), static_cast<std::int64_t>(ticks / 25));
    last = now;
  }
}

struct TestClock final : Clock {
  [[nodiscard]] Timestamp now() override { return time; }
  Timestamp time{};
};

/// A UART at 115200 baud whose interrupts come in `wait`.
struct Uart final : SerialPort {
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    return rings.read(buffer, clock_);
  }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    return rings.write(bytes);
  }
  [[nodiscard]] std::uint32_t baud() const override { return 115'200; }
  [[nodiscard]] std::uint32_t lost() const override { return rings.lost(); }

  SerialPort& port() { return *this; }
  Timestamp now() { return clock_.now(); }
  bool inject(std::span<const std::uint8_t> bytes) {
    coming.insert(coming.end(), bytes.begin(), bytes.end());
    return true;
  }
  std::size_t sent(std::span<std::uint8_t> buffer) {
    std::size_t size = 0;
    while (size < buffer.size() && rings.next_to_send(buffer[size])) { ++size; }
    return size;
  }
  void wait(Duration duration) {
    const Timestamp end = clock_.time + duration;
    for (const std::uint8_t byte : coming) {
      clock_.time += Duration{87};
      rings.received(byte, clock_.time);
    }
    coming.clear();
    clock_.time = std::max(end, clock_.time);
  }

  TestClock clock_;
  SerialRings rings;
  std::vector<std::uint8_t> coming;
};

TEST(SerialRings, KeepTheContractsOfASerialPort) {
  Uart uart;
  test::expect_conformance(uart, conformance::check_serial_port<Uart>, 20);
}

TEST(SerialRings, StampSurvivesEveryWrapOfItsShortForm) {
  for (const std::int64_t start : {0LL, 0xFF'FFF0LL, 0xFFFF'FFFALL, 0x1'0000'0000'0000LL}) {
    Uart uart;
    uart.clock_.time = Timestamp{Duration{start}};
    uart.rings.received(7, uart.now());
    uart.clock_.time += Duration{15'000'000};
    std::array<std::uint8_t, 4> bytes{};
    const Result<SerialRead> read = uart.read(bytes);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->last_byte_stamp.time_since_epoch().count(), start);
    EXPECT_EQ(read->source, StampSource::hardware);
  }
}

TEST(SerialRings, CountWhatDidNotFitAndWhatTheHardwareLost) {
  Uart uart;
  for (std::uint32_t i = 0; i < SerialRings::kReceive + 5; ++i) { uart.rings.received(0, {}); }
  uart.rings.overrun();
  EXPECT_EQ(uart.lost(), 6U);
  EXPECT_EQ(uart.rings.arrived(), SerialRings::kReceive + 5);
}

struct Memory {
  static constexpr std::size_t kSector = 256;
  std::array<std::uint8_t, 4 * kSector> bytes{};
  MemoryByteStore memory_store{bytes, kSector};
  ByteStore& store() { return memory_store; }
  void reopen() { memory_store = MemoryByteStore{bytes, kSector}; }
};

TEST(MemoryByteStore, KeepsTheContractsOfAStore) {
  Memory memory;
  test::expect_conformance(memory, conformance::check_byte_store<Memory>, 18);
  EXPECT_TRUE(memory.memory_store.survived());
}

struct SlowMemory : Memory {
  test::SlowFlash flash{memory_store, 7};
  ByteStore& store() { return flash; }
};

TEST(MemoryByteStore, ErasedInTheBackgroundKeepsTheSameContracts) {
  SlowMemory memory;
  test::expect_conformance(memory, conformance::check_byte_store<SlowMemory>, 18);
  EXPECT_GT(memory.flash.waits, 0U);
}

TEST(MemoryByteStore, ErasesMemoryThatWasNeverAStore) {
  std::array<std::uint8_t, 4 * Memory::kSector> bytes{};
  bytes.fill(0x42);
  MemoryByteStore store{bytes, Memory::kSector};
  EXPECT_FALSE(store.survived());
  std::uint8_t byte = 0;
  EXPECT_EQ(store.read(store.geometry().size - 1, {&byte, 1}), Status::ok);
  EXPECT_EQ(byte, 0xFF);
}

}  // namespace
}  // namespace picolo::board
