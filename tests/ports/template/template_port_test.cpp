// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The empty port fails the conformance suite, and the suite's first message always names the
// function that a porter who works from the top has to write next, until all twelve are there.

#include "picolo/template/template_port.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "picolo/hal/conformance/suite.hpp"
#include "picolo/sim/sim_byte_store.hpp"
#include "picolo/sim/sim_can_bus.hpp"
#include "picolo/sim/sim_clock.hpp"
#include "picolo/sim/sim_serial_port.hpp"
#include "picolo/sim/sim_watchdog.hpp"
#include "picolo/template/template_bench.hpp"

namespace picolo::template_port {
namespace {

/// What a porter is told.
std::string tell(auto& bench, std::uint32_t& violated) {
  static std::string text;  // Write takes no context
  text.clear();
  conformance::Suite suite{[](const char* words) { text += words; }};
  conformance::check_port(bench, suite);
  violated = suite.violated();
  return text;
}

std::string first_violation(const std::string& text) {
  const std::size_t at = text.find("violated: ");
  return at == std::string::npos ? "" : text.substr(at, text.find("cure:", at) - at);
}

TEST(EmptyPort, StopsAtItsClockWithAMessage) {
  TemplateBench bench;
  std::uint32_t violated = 0;
  const std::string text = tell(bench, violated);
  EXPECT_GT(violated, 0U);
  EXPECT_NE(first_violation(text).find("Clock::now counts microseconds"), std::string::npos)
      << text;
  EXPECT_NE(text.find("check the timer's clock source"), std::string::npos) << text;
  EXPECT_EQ(text.find("SerialPort: "), std::string::npos) << text;
}

/// The functions in the order of template_port.cpp.
enum class Step {
  nothing,
  clock_now,
  serial_read,
  serial_write,
  can_receive,
  can_transmit,
  store_geometry,
  store_erase,
  store_read,
  store_program,
  counter_rate,
  counter_cycles,
  watchdog_stroke
};

/// A board on which the first functions are written and the others still the template's.
class Board {
 public:
  explicit Board(Step done) : done_(done) {}

  Clock& clock() { return time_; }
  SerialPort& port() { return port_; }
  CanBus& bus() { return bus_; }
  ByteStore& store() { return store_; }
  CycleCounter& cycle_counter() { return counter_; }
  Watchdog& watchdog() { return dog_; }
  Duration period() { return sim_dog_.period(); }
  Timestamp now() { return time_.now(); }
  void wait(Duration duration) { sim_time_.advance(duration); }
  bool inject(std::span<const std::uint8_t> bytes) {
    sim_port_.deliver(bytes, sim_time_.now());
    return true;
  }
  std::size_t sent(std::span<std::uint8_t> buffer) { return sim_port_.take_written(buffer); }
  bool inject(CanFrame frame) {
    frame.stamp = sim_time_.now();
    sim_bus_.deliver(frame);
    return true;
  }
  Result<CanFrame> sent() { return sim_bus_.take_sent(sim_time_.now()); }
  bool fired() { return sim_dog_.expired(); }

 private:
  [[nodiscard]] bool written(Step step) const { return done_ >= step; }

  struct Time final : Clock {
    explicit Time(Board& board) : b(board) {}
    [[nodiscard]] Timestamp now() override {
      return b.written(Step::clock_now) ? b.sim_time_.now() : TemplateClock{}.now();
    }
    Board& b;
  };
  struct Port final : SerialPort {
    explicit Port(Board& board) : b(board) {}
    Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
      return b.written(Step::serial_read) ? b.sim_port_.read(buffer) : empty.read(buffer);
    }
    Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
      return b.written(Step::serial_write) ? b.sim_port_.write(bytes) : empty.write(bytes);
    }
    [[nodiscard]] std::uint32_t baud() const override { return empty.baud(); }
    [[nodiscard]] std::uint32_t lost() const override { return empty.lost(); }
    Board& b;
    TemplateSerialPort empty;
  };
  struct Bus final : CanBus {
    explicit Bus(Board& board) : b(board) {}
    Result<CanFrame> receive() override {
      return b.written(Step::can_receive) ? b.sim_bus_.receive() : empty.receive();
    }
    Status transmit(const CanFrame& frame) override {
      return b.written(Step::can_transmit) ? b.sim_bus_.transmit(frame) : empty.transmit(frame);
    }
    [[nodiscard]] CanStatus status() const override {
      return b.written(Step::can_receive) ? b.sim_bus_.status() : empty.status();
    }
    Board& b;
    TemplateCanBus empty;
  };
  struct Store final : ByteStore {
    explicit Store(Board& board) : b(board) {}
    [[nodiscard]] ByteStoreGeometry geometry() const override {
      return b.written(Step::store_geometry) ? b.sim_store_.geometry() : empty.geometry();
    }
    Status erase(std::size_t address) override {
      return b.written(Step::store_erase) ? b.sim_store_.erase(address) : empty.erase(address);
    }
    Status read(std::size_t address, std::span<std::uint8_t> bytes) override {
      return b.written(Step::store_read) ? b.sim_store_.read(address, bytes)
                                         : empty.read(address, bytes);
    }
    Status program(std::size_t address, std::span<const std::uint8_t> bytes) override {
      return b.written(Step::store_program) ? b.sim_store_.program(address, bytes)
                                            : empty.program(address, bytes);
    }
    Board& b;
    TemplateByteStore empty;
  };
  struct Counter final : CycleCounter {
    explicit Counter(Board& board) : b(board) {}
    [[nodiscard]] std::uint32_t cycles() override {
      return b.written(Step::counter_cycles) ? b.sim_counter_.cycles() : empty.cycles();
    }
    [[nodiscard]] std::uint32_t cycles_per_us() const override {
      return b.written(Step::counter_rate) ? b.sim_counter_.cycles_per_us() : empty.cycles_per_us();
    }
    Board& b;
    TemplateCycleCounter empty;
  };
  struct Dog final : Watchdog {
    explicit Dog(Board& board) : b(board) {}
    void stroke() override {
      if (b.written(Step::watchdog_stroke)) {
        b.sim_dog_.stroke();
      } else {
        TemplateWatchdog{}.stroke();
      }
    }
    Board& b;
  };

  Step done_;
  std::array<std::uint8_t, 1024> memory_{};
  sim::SimClock sim_time_{Timestamp{5s}};
  sim::SimSerialPort sim_port_{sim_time_, 115'200};
  sim::SimCanBus sim_bus_{sim_time_};
  sim::SimByteStore sim_store_{memory_, 256, 4};
  sim::SimCycleCounter sim_counter_{sim_time_};
  sim::SimWatchdog sim_dog_{sim_time_, 1h};
  Time time_{*this};
  Port port_{*this};
  Bus bus_{*this};
  Store store_{*this};
  Counter counter_{*this};
  Dog dog_{*this};
};

TEST(EmptyPort, IsLedThroughItsTwelveFunctionsInOrder) {
  const char* const next[] = {"Clock::now",
                              "SerialPort::read",
                              "SerialPort::write",
                              "CanBus::receive",
                              "CanBus::transmit",
                              "sector",
                              "ByteStore::erase",
                              "ByteStore::read",
                              "ByteStore::program",
                              "CycleCounter::cycles_per_us",
                              "CycleCounter::cycles runs",
                              "stroked twice a period"};
  for (std::size_t done = 0; done < std::size(next); ++done) {
    Board board{static_cast<Step>(done)};
    std::uint32_t violated = 0;
    const std::string text = tell(board, violated);
    EXPECT_GT(violated, 0U) << done;
    EXPECT_NE(first_violation(text).find(next[done]), std::string::npos) << done << "\n" << text;
  }
  Board board{Step::watchdog_stroke};
  std::uint32_t violated = 0;
  const std::string text = tell(board, violated);
  EXPECT_EQ(violated, 0U) << text;
  EXPECT_NE(text.find("Watchdog: 3 contracts checked, 0 violated"), std::string::npos) << text;
}

}  // namespace
}  // namespace picolo::template_port
