// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// SlcanBus keeps the contracts of hal on a simulated serial line, and lives through what such lines
// and adapters do.

#include "picolo/drivers/slcan/slcan_bus.hpp"

#include <gtest/gtest.h>

#include "picolo/hal/conformance/can_bus.hpp"
#include "picolo/sim/sim_clock.hpp"
#include "picolo/sim/sim_serial_port.hpp"
#include "support/conformance.hpp"
#include "support/slcan_adapter.hpp"

namespace picolo {
namespace {

/// A bus, its line, and the adapter at the line's end.
struct Wire {
  sim::SimClock clock{Timestamp{5s}};
  sim::SimSerialPort port{clock, 1'000'000};
  SlcanBus slcan{port, {.bit_rate = 250'000}};
  test::SlcanAdapter adapter;

  CanBus& bus() { return slcan; }
  Timestamp now() { return clock.now(); }
  void wait(Duration duration) {
    exchange();
    clock.advance(duration);
  }
  /// What the board wrote reaches the adapter, its answers the line.
  void exchange() {
    std::array<std::uint8_t, 64> bytes{};
    while (const std::size_t count = port.take_written(bytes)) {
      adapter.take(std::span{bytes}.first(count));
    }
    say(adapter.answers);
    adapter.answers.clear();
  }
  void say(const std::string& text) {
    (void)port.deliver(std::vector<std::uint8_t>(text.begin(), text.end()), now());
  }
  bool inject(const CanFrame& frame) {
    say(test::SlcanAdapter::line_of(frame));
    return true;
  }
  Result<CanFrame> sent() {
    exchange();
    if (adapter.frames.empty()) { return Status::not_ready; }
    const CanFrame frame = adapter.frames.front();
    adapter.frames.pop_front();
    return frame;
  }
  void unplug_bus() { port.set_connected(false); }
  void plug_bus() {
    port.set_connected(true);
    adapter = {};
  }
  /// All frames that wait.
  std::vector<CanFrame> drain() {
    std::vector<CanFrame> frames;
    for (int i = 0; i < 100; ++i) {
      if (const Result<CanFrame> frame = slcan.receive()) { frames.push_back(*frame); }
    }
    return frames;
  }
};

TEST(SlcanBus, KeepsTheContractsOfHal) {
  Wire wire;
  test::expect_conformance(wire, conformance::check_can_bus<Wire>, 34);
  EXPECT_EQ(wire.slcan.counters().malformed, 0U);
  EXPECT_EQ(wire.slcan.counters().opened, 2U) << "once more after the line came back";
  EXPECT_EQ(wire.adapter.damaged, 0U);
}

TEST(SlcanBus, TellsTheAdapterItsRateBeforeAnythingElse) {
  Wire wire;
  EXPECT_EQ(wire.slcan.receive().status(), Status::not_ready);
  wire.wait(1ms);
  EXPECT_TRUE(wire.adapter.open);
  EXPECT_EQ(wire.adapter.rate, '5');
  EXPECT_TRUE(wire.drain().empty()) << "answers are no frames";
  EXPECT_EQ(wire.slcan.counters().refused, 1U) << "to close what was not open";
  EXPECT_EQ(wire.slcan.counters().answers, 3U);
}

TEST(SlcanBus, StampsAFrameWithTheBeginOfItsLine) {
  Wire wire;
  (void)wire.drain();
  wire.wait(10ms);
  const Timestamp begin = wire.now();
  // 10, 6, 40 (no line of the protocol) and 6 bytes of 10 us each.
  wire.say("t12320102\rt1230\r" + std::string(39, 't') + "\rt1230\r");
  wire.wait(5ms);
  const std::vector<CanFrame> frames = wire.drain();
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0].stamp - begin, Duration{0});
  EXPECT_EQ(frames[1].stamp - begin, Duration{100});
  EXPECT_EQ(frames[2].stamp - begin, Duration{560});
}

TEST(SlcanBus, GoesOnBehindALineThatIsNone) {
  for (const char* damage :
       {"t12320", "x", "t8001", "t12390102030405060708", "tttttttttttttttttt", "T2000000001",
        "t1232010", "t12320102030405060708010203040506070809", "\xFF\xFE"}) {
    Wire wire;
    wire.say(std::string{damage} + "\rt1231AA\r");
    wire.wait(5ms);
    const std::vector<CanFrame> frames = wire.drain();
    ASSERT_EQ(frames.size(), 1U) << damage;
    EXPECT_EQ(frames[0].data[0], 0xAA);
    EXPECT_EQ(wire.slcan.counters().malformed, 1U) << damage;
    EXPECT_EQ(wire.slcan.status().rx_lost, 1U) << damage;
  }
}

TEST(SlcanBus, TakesALineThatComesInPieces) {
  Wire wire;
  (void)wire.drain();
  wire.wait(1ms);
  (void)wire.drain();  // the answers
  for (const char* piece : {"t", "12", "3", "1A", "A", "\r"}) {
    EXPECT_EQ(wire.slcan.receive().status(), Status::not_ready);
    wire.say(piece);
    wire.wait(1ms);
  }
  EXPECT_EQ(wire.drain().size(), 1U);
}

/// Loses what it is told to, as a UART whose interrupt came too late.
struct LossyPort final : SerialPort {
  explicit LossyPort(SerialPort& port) : port_(port) {}
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override { return port_.read(buffer); }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    return port_.write(bytes);
  }
  [[nodiscard]] std::uint32_t baud() const override { return port_.baud(); }
  [[nodiscard]] std::uint32_t lost() const override { return lost_bytes; }
  std::uint32_t lost_bytes = 0;
  SerialPort& port_;
};

TEST(SlcanBus, NeverMakesOneFrameOfTwoWhenBytesWereLost) {
  Wire wire;
  LossyPort lossy{wire.port};
  SlcanBus slcan{lossy};
  wire.say("t1234AABB");  // CCDD, the end and t1234 1122 of the next line are lost
  wire.wait(1ms);
  EXPECT_EQ(slcan.receive().status(), Status::not_ready);
  lossy.lost_bytes += 14;
  wire.say("3344\rt7770\r");
  wire.wait(1ms);
  const Result<CanFrame> frame = slcan.receive();
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->id, 0x777U);
  EXPECT_EQ(slcan.status().rx_lost, 1U);
}

TEST(SlcanBus, OpensAnAdapterAgainThatHasForgotten) {
  Wire wire;
  (void)wire.drain();
  wire.wait(5ms);
  wire.adapter = {};  // its power failed, the line's did not
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(wire.slcan.transmit({.id = 0x123}), Status::ok);
    wire.wait(5ms);
    (void)wire.drain();
  }
  EXPECT_EQ(wire.slcan.counters().opened, 2U);
  EXPECT_GE(wire.adapter.frames.size(), 10U);
}

}  // namespace
}  // namespace picolo
