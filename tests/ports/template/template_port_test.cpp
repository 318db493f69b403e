// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The empty port fails the conformance suite with messages that lead a porter through it, one
// function after the other.

#include "picolo/template/template_port.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "picolo/hal/conformance/byte_store.hpp"
#include "picolo/hal/conformance/can_bus.hpp"
#include "picolo/hal/conformance/clock.hpp"
#include "picolo/hal/conformance/serial_port.hpp"
#include "picolo/hal/conformance/watchdog.hpp"

namespace picolo::template_port {
namespace {

/// A board without a wire: nothing can be injected, nothing comes out.
struct EmptyBoard {
  TemplateClock template_clock;
  TemplateCycleCounter template_counter;
  TemplateCanBus template_bus;
  TemplateSerialPort template_port;
  TemplateByteStore template_store;
  TemplateWatchdog template_dog;

  Clock& clock() { return template_clock; }
  CycleCounter& cycle_counter() { return template_counter; }
  CanBus& bus() { return template_bus; }
  SerialPort& port() { return template_port; }
  ByteStore& store() { return template_store; }
  Watchdog& watchdog() { return template_dog; }
  Timestamp now() { return template_clock.now(); }
  void wait(Duration) {}
  bool inject(const CanFrame&) { return false; }
  bool inject(std::span<const std::uint8_t>) { return false; }
  Result<CanFrame> sent() { return Status::not_ready; }
  std::size_t sent(std::span<std::uint8_t>) { return 0; }
  Duration period() { return 100ms; }
  bool fired() { return false; }
};

struct Message {
  std::string contract;
  std::string cure;
};

class EmptyPort : public ::testing::Test {
 protected:
  static void report(void* context, const char* contract, const char* cure) {
    static_cast<std::vector<Message>*>(context)->push_back({contract, cure});
  }

  void expect_first_message(const std::string& words) {
    ASSERT_FALSE(messages.empty()) << "an empty function passed";
    EXPECT_NE(messages.front().contract.find(words), std::string::npos)
        << messages.front().contract;
    for (const Message& message : messages) { EXPECT_GT(message.cure.size(), 5U); }
  }

  std::vector<Message> messages;
  conformance::Checker checker{report, &messages};
  EmptyBoard board;
};

TEST_F(EmptyPort, ClockDoesNotRun) {
  conformance::check_clock(board, checker);
  expect_first_message("counts microseconds");
}

TEST_F(EmptyPort, CanBusReceivesNothing) {
  conformance::check_can_bus(board, checker);
  expect_first_message("standard frames");
}

TEST_F(EmptyPort, SerialPortReadsNothing) {
  conformance::check_serial_port(board, checker);
  expect_first_message("256 bytes between two reads");
}

TEST_F(EmptyPort, ByteStoreHasNoGeometry) {
  conformance::check_byte_store(board, checker);
  expect_first_message("sector");
}

TEST_F(EmptyPort, WatchdogDoesNotFire) {
  conformance::check_watchdog(board, checker);
  expect_first_message("not stroked fires");
}

}  // namespace
}  // namespace picolo::template_port
