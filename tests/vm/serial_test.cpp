// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Serial lines with true drivers: a UART of the board, joined to a USB adapter (FTDI).

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "picolo/hal/conformance/serial_port.hpp"
#include "picolo/linux/linux_clock.hpp"
#include "picolo/linux/termios_serial_port.hpp"
#include "shell.hpp"
#include "support/conformance.hpp"

namespace picolo::test {
namespace {

constexpr const char* kUart = "/dev/ttyS2";
constexpr const char* kAdapter = "/dev/ttyUSB0";

/// A line from one device to the other; `device` plays the device at the far end.
struct Line {
  Line(const char* near_end, const char* far_end) {
    EXPECT_EQ(device.open(far_end), Status::ok);
    EXPECT_EQ(serial.open(near_end), Status::ok);
  }
  SerialPort& port() { return serial; }
  bool inject(std::span<const std::uint8_t> bytes) {
    return device.write(bytes).value_or(0) == bytes.size();
  }
  std::size_t sent(std::span<std::uint8_t> buffer) {
    std::size_t size = 0;
    for (auto read = device.read(buffer); read; read = device.read(buffer.subspan(size))) {
      size += read->size;
    }
    return size;
  }
  [[nodiscard]] Timestamp now() { return clock.now(); }
  void wait(Duration duration) { static_cast<void>(sleep_until(clock.now() + duration / 4)); }

  LinuxClock clock;
  TermiosSerialPort serial{clock, {.baud = 115'200, .retry_period = 100ms}};
  TermiosSerialPort device{clock, {.baud = 115'200}};
};

/// Pulled and plugged in again, as far as the kernel can tell.
struct PluggableLine : Line {
  PluggableLine() : Line(kAdapter, kUart) {
    shell("readlink -f /sys/class/tty/ttyUSB0/device/../.. > /tmp/adapter");
  }
  void unplug() { shell("echo 0 > $(cat /tmp/adapter)/authorized"); }
  void plug() { shell("echo 1 > $(cat /tmp/adapter)/authorized"); }
};

TEST(MachineSerial, AUartCarriesEveryByteBothWays) {
  Line line{kUart, kAdapter};
  conformance::Checker checker = failing_checker();
  conformance::detail::serial_port_reads(line, checker);
  conformance::detail::serial_port_writes(line, checker);
  EXPECT_GT(checker.checked(), 10U);
}

TEST(MachineSerial, AUsbAdapterCarriesEveryByteAndIsFoundAgainAfterItWasPulled) {
  PluggableLine line;
  conformance::Checker checker = failing_checker();
  conformance::detail::serial_port_reads(line, checker);
  conformance::detail::serial_port_writes(line, checker);
  conformance::detail::serial_port_comes_back(line, checker);
  EXPECT_GT(checker.checked(), 12U);
  EXPECT_EQ(line.serial.disconnects(), 1U);
  EXPECT_TRUE(line.serial.low_latency());
}

TEST(MachineSerial, AUsbAdapterDoesTheRatesOfAllLidarsAndAnyOther) {
  LinuxClock clock;
  for (const std::uint32_t rate :
       {9'600U, 19'200U, 115'200U, 128'000U, 230'400U, 256'000U, 460'800U, 512'000U, 921'600U,
        1'000'000U, 1'500'000U, 3'000'000U, 123'457U, 750'000U}) {
    TermiosSerialPort port{clock, {.baud = rate}};
    EXPECT_EQ(port.open(kAdapter), Status::ok) << rate;
  }
}

// Its clock of 1.8432 MHz is divided by 16 at least.
TEST(MachineSerial, AUartThatCannotDoARateSaysSo) {
  LinuxClock clock;
  for (const std::uint32_t rate : {9'600U, 19'200U, 38'400U, 57'600U, 115'200U}) {
    TermiosSerialPort port{clock, {.baud = rate}};
    EXPECT_EQ(port.open(kUart), Status::ok) << rate;
  }
  for (const std::uint32_t rate : {230'400U, 256'000U, 1'000'000U}) {
    TermiosSerialPort port{clock, {.baud = rate}};
    EXPECT_EQ(port.open(kUart), Status::unsupported) << rate;
  }
}

TEST(MachineSerial, AUsbAdapterIsToldToHandBytesOnAtOnce) {
  LinuxClock clock;
  TermiosSerialPort port{clock, {.baud = 230'400}};
  ASSERT_EQ(port.open(kAdapter), Status::ok);
  EXPECT_TRUE(port.low_latency());
  std::ifstream file{"/sys/bus/usb-serial/devices/ttyUSB0/latency_timer"};
  int milliseconds = 0;
  ASSERT_TRUE(file >> milliseconds);
  EXPECT_EQ(milliseconds, 1);
}

}  // namespace
}  // namespace picolo::test
