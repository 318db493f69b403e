// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Raw mode, every rate, unplugging: on pseudo-terminals.

#include "picolo/linux/termios_serial_port.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <iostream>
#include <string>
#include <vector>

#include "picolo/linux/linux_clock.hpp"
#include "pseudo_terminal.hpp"
#include "system_calls.hpp"

namespace picolo {
namespace {

class SettableClock final : public Clock {
 public:
  [[nodiscard]] Timestamp now() override { return time; }
  Timestamp time{1s};
};

class TermiosTest : public ::testing::Test {
 protected:
  SettableClock clock;
  test::PseudoTerminal terminal;
  std::array<std::uint8_t, 64> buffer{};
};

TEST_F(TermiosTest, WhenOpenedThenTheLineIsRawAs8N1WithoutFlowControl) {
  TermiosSerialPort port{clock, {.baud = 115'200}};
  ASSERT_EQ(port.open(terminal.path().c_str()), Status::ok);
  const FileDescriptor line{::open(terminal.path().c_str(), O_RDWR | O_NOCTTY)};
  termios settings{};
  ASSERT_EQ(::tcgetattr(line.get(), &settings), 0);
  EXPECT_EQ(settings.c_iflag &
                (IGNBRK | BRKINT | PARMRK | ISTRIP | INLCR | IGNCR | ICRNL | IXON | IXOFF | IXANY),
            0U);
  EXPECT_EQ(settings.c_oflag & OPOST, 0U);
  EXPECT_EQ(settings.c_lflag & (ECHO | ECHONL | ICANON | ISIG | IEXTEN), 0U);
  EXPECT_EQ(settings.c_cflag & CSIZE, static_cast<tcflag_t>(CS8));
  EXPECT_EQ(settings.c_cflag & (PARENB | CSTOPB | CRTSCTS), 0U);
  EXPECT_NE(settings.c_cflag & CREAD, 0U);
}

TEST_F(TermiosTest, GivenTheRatesOfTheDevicesThenEachIsSet) {
  for (const std::uint32_t rate : {9'600U, 19'200U, 115'200U, 128'000U, 230'400U, 256'000U,
                                   460'800U, 512'000U, 921'600U, 1'000'000U, 123'457U}) {
    TermiosSerialPort port{clock, {.baud = rate}};
    ASSERT_EQ(port.open(terminal.path().c_str()), Status::ok) << rate;
    EXPECT_EQ(port.baud(), rate);
    const FileDescriptor line{::open(terminal.path().c_str(), O_RDWR | O_NOCTTY)};
    EXPECT_EQ(test::line_rate(line.get()), rate);
  }
}

TEST_F(TermiosTest, GivenAnotherRateThenItIsSetAndTheDriverHearsOfAnInterruption) {
  TermiosSerialPort port{clock, {.baud = 9'600}};
  ASSERT_EQ(port.open(terminal.path().c_str()), Status::ok);
  ASSERT_TRUE(terminal.send(std::array<std::uint8_t, 2>{1, 2}));
  ::usleep(20'000);
  ASSERT_EQ(port.set_baud(256'000), Status::ok);
  EXPECT_EQ(port.baud(), 256'000U);
  const FileDescriptor line{::open(terminal.path().c_str(), O_RDWR | O_NOCTTY)};
  EXPECT_EQ(test::line_rate(line.get()), 256'000U);
  EXPECT_EQ(port.read(buffer).status(), Status::disconnected) << "once";
  EXPECT_EQ(port.read(buffer).status(), Status::not_ready) << "what came at the old rate is void";
  EXPECT_EQ(port.disconnects(), 0U);
  EXPECT_EQ(port.set_baud(0), Status::invalid_argument);
  TermiosSerialPort closed{clock, {.baud = 9'600}};
  EXPECT_EQ(closed.set_baud(115'200), Status::ok);
  ASSERT_EQ(closed.open(terminal.path().c_str()), Status::ok);
  EXPECT_EQ(test::line_rate(line.get()), 115'200U);
}

TEST_F(TermiosTest, WhenReadThenTheStampIsTheTimeOfTheRead) {
  TermiosSerialPort port{clock, {}};
  ASSERT_EQ(port.open(terminal.path().c_str()), Status::ok);
  ASSERT_TRUE(terminal.send(std::array<std::uint8_t, 3>{0x04, 0x0D, 0x11}));
  ::usleep(20'000);
  clock.time = Timestamp{77s};
  const auto read = port.read(buffer);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->size, 3U);
  EXPECT_EQ(read->last_byte_stamp, Timestamp{77s});
  EXPECT_EQ(read->source, StampSource::read);
  EXPECT_EQ(buffer[0], 0x04);
  EXPECT_EQ(buffer[1], 0x0D);
  EXPECT_EQ(buffer[2], 0x11);
}

TEST_F(TermiosTest, GivenBytesFromBeforeTheOpeningThenTheyAreThrownAway) {
  {
    TermiosSerialPort first{clock, {}};
    ASSERT_EQ(first.open(terminal.path().c_str()), Status::ok);
  }
  ASSERT_TRUE(terminal.send(std::array<std::uint8_t, 2>{1, 2}));
  ::usleep(20'000);
  TermiosSerialPort port{clock, {}};
  ASSERT_EQ(port.open(terminal.path().c_str()), Status::ok);
  EXPECT_EQ(port.read(buffer).status(), Status::not_ready);
}

TEST_F(TermiosTest, GivenAnUnpluggedDeviceThenItIsLookedForOnlyOncePerPeriod) {
  TermiosSerialPort port{clock, {.retry_period = 500ms}};
  ASSERT_EQ(port.open(terminal.path().c_str()), Status::ok);
  terminal.unplug();
  EXPECT_EQ(port.read(buffer).status(), Status::disconnected);
  EXPECT_EQ(port.disconnects(), 1U);
  EXPECT_FALSE(port.is_open());
  terminal.plug();
  clock.time += 499ms;
  EXPECT_EQ(port.read(buffer).status(), Status::disconnected);
  clock.time += 1ms;
  EXPECT_EQ(port.read(buffer).status(), Status::not_ready);
  EXPECT_TRUE(port.is_open());
  EXPECT_EQ(port.lost(), 0U);
}

TEST_F(TermiosTest, GivenAnUnpluggedDeviceThenTenSecondsOfCyclesCostOneSystemCallATry) {
  TermiosSerialPort port{clock, {.retry_period = 500ms}};
  ASSERT_EQ(port.open(terminal.path().c_str()), Status::ok);
  terminal.unplug();
  const auto calls = test::system_calls_of([&] {
    for (int cycle = 0; cycle < 2000; ++cycle) {
      clock.time += 5ms;
      static_cast<void>(port.read(buffer));
      static_cast<void>(port.write(std::array<std::uint8_t, 2>{0xA5, 0x25}));
    }
  });
  if (!calls) { GTEST_SKIP() << "this process may not trace others"; }
  std::cout << *calls << " system calls in 2000 cycles\n";
  EXPECT_GE(*calls, 20);
  EXPECT_LE(*calls, 40) << "20 tries, and the end of the device";
}

TEST_F(TermiosTest, GivenAnUnpluggedDeviceThenWritingNoticesItToo) {
  TermiosSerialPort port{clock, {}};
  ASSERT_EQ(port.open(terminal.path().c_str()), Status::ok);
  EXPECT_EQ(port.write({}).value_or(99), 0U);
  terminal.unplug();
  EXPECT_EQ(port.write(buffer).status(), Status::disconnected);
  EXPECT_EQ(port.disconnects(), 1U);
}

TEST_F(TermiosTest, GivenAnAdoptedLineThenItIsNotOpenedAgain) {
  TermiosSerialPort port{clock, {}};
  ASSERT_EQ(port.adopt(::open(terminal.path().c_str(), O_RDWR | O_NOCTTY)), Status::ok);
  EXPECT_EQ(port.read(buffer).status(), Status::not_ready);
  terminal.unplug();
  EXPECT_EQ(port.read(buffer).status(), Status::disconnected);
  terminal.plug();
  clock.time += 10s;
  EXPECT_EQ(port.read(buffer).status(), Status::disconnected);
}

TEST_F(TermiosTest, GivenWhatIsNoTerminalThenUnsupported) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const FileDescriptor other{ends[1]};
  TermiosSerialPort port{clock, {}};
  EXPECT_EQ(port.adopt(ends[0]), Status::unsupported);
  EXPECT_FALSE(port.is_open());
  EXPECT_EQ(port.open("/dev/null"), Status::unsupported);
}

TEST_F(TermiosTest, GivenNonsenseThenItIsRefused) {
  TermiosSerialPort port{clock, {}};
  EXPECT_EQ(port.open(""), Status::invalid_argument);
  EXPECT_EQ(port.open(std::string(300, 'x').c_str()), Status::invalid_argument);
  EXPECT_EQ(port.open("/no/such/device"), Status::io_error);
  EXPECT_EQ(port.adopt(-1), Status::io_error);
  TermiosSerialPort no_rate{clock, {.baud = 0}};
  EXPECT_EQ(no_rate.open(terminal.path().c_str()), Status::invalid_argument);
  EXPECT_EQ(port.read(buffer).status(), Status::disconnected);
  EXPECT_EQ(port.write(buffer).status(), Status::disconnected);
}

}  // namespace
}  // namespace picolo
