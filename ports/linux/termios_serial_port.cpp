// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/linux/termios_serial_port.hpp"

// The kernel's own struct termios2 knows arbitrary rates; it and <termios.h> cannot be included
// together.
#include <asm/ioctls.h>
#include <asm/termbits.h>
#include <fcntl.h>
#include <linux/serial.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace picolo::inline v0 {
namespace {

bool same_rate(std::uint32_t wanted, std::uint32_t got) {
  const std::int64_t difference = std::int64_t{wanted} - std::int64_t{got};
  return (difference < 0 ? -difference : difference) * 100 <= std::int64_t{wanted} * 3;
}

/// Everything that cfmakeraw clears, no flow control, no modem lines, 8N1. VMIN 1 with O_NONBLOCK
/// tells "nothing yet" (EAGAIN) from "hung up" (0); VMIN 0 does not.
Status make_raw(int fd, std::uint32_t baud) {
  termios2 line{};
  if (::ioctl(fd, TCGETS2, &line) != 0) { return Status::unsupported; }
  line.c_iflag = 0;
  line.c_oflag = 0;
  line.c_lflag = 0;
  line.c_cflag = CS8 | CREAD | CLOCAL | BOTHER;
  line.c_ispeed = baud;
  line.c_ospeed = baud;
  line.c_cc[VMIN] = 1;
  line.c_cc[VTIME] = 0;
  if (::ioctl(fd, TCSETS2, &line) != 0) { return Status::unsupported; }
  termios2 actual{};
  if (::ioctl(fd, TCGETS2, &actual) != 0) { return Status::io_error; }
  return same_rate(baud, actual.c_ospeed) ? Status::ok : Status::unsupported;
}

constexpr auto kLowLatency = static_cast<int>(ASYNC_LOW_LATENCY);

/// USB adapters hold bytes back for up to 16 ms otherwise. Where it is not offered nothing is lost.
void ask_for_low_latency(int fd) {
  serial_struct settings{};
  if (::ioctl(fd, TIOCGSERIAL, &settings) != 0) { return; }
  settings.flags |= kLowLatency;
  static_cast<void>(::ioctl(fd, TIOCSSERIAL, &settings));
}

}  // namespace

Status TermiosSerialPort::open(const char* path) {
  device_.close();
  path_[0] = '\0';
  const std::size_t length = std::strlen(path);
  if (!config_.valid() || length == 0 || length >= path_.size()) {
    return Status::invalid_argument;
  }
  std::memcpy(path_.data(), path, length + 1);
  return try_open();
}

Status TermiosSerialPort::adopt(int fd) {
  path_[0] = '\0';
  FileDescriptor device{fd};
  if (!config_.valid()) { return Status::invalid_argument; }
  const int flags = ::fcntl(fd, F_GETFL);
  if (flags < 0 || ::fcntl(fd, F_SETFL, flags | O_NONBLOCK) != 0) { return Status::io_error; }
  return set_up(std::move(device));
}

Status TermiosSerialPort::try_open() {
  FileDescriptor device{::open(path_.data(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)};
  return device.is_open() ? set_up(std::move(device)) : Status::io_error;
}

Status TermiosSerialPort::set_up(FileDescriptor device) {
  const Status status = make_raw(device.get(), config_.baud);
  if (!is_ok(status)) { return status; }
  ask_for_low_latency(device.get());
  int dtr = TIOCM_DTR;
  static_cast<void>(::ioctl(device.get(), config_.dtr ? TIOCMBIS : TIOCMBIC, &dtr));
  static_cast<void>(::ioctl(device.get(), TCFLSH, TCIFLUSH));
  device_ = std::move(device);
  overruns_at_open_ = overruns();
  return Status::ok;
}

Status TermiosSerialPort::set_baud(std::uint32_t baud) {
  if (baud == 0) { return Status::invalid_argument; }
  if (device_.is_open()) {
    const Status status = make_raw(device_.get(), baud);
    if (!is_ok(status)) {
      static_cast<void>(make_raw(device_.get(), config_.baud));
      return status;
    }
    static_cast<void>(::ioctl(device_.get(), TCFLSH, TCIFLUSH));
    rate_changed_ = true;
  }
  config_.baud = baud;
  return Status::ok;
}

Result<SerialRead> TermiosSerialPort::read(std::span<std::uint8_t> buffer) {
  if (!device_.is_open()) {
    const Timestamp now = clock_.now();
    if (path_[0] == '\0' || now < next_try_) { return Status::disconnected; }
    next_try_ = now + config_.retry_period;
    if (!is_ok(try_open())) { return Status::disconnected; }
  }
  if (std::exchange(rate_changed_, false)) { return Status::disconnected; }
  if (buffer.empty()) { return Status::not_ready; }
  const ssize_t count = ::read(device_.get(), buffer.data(), buffer.size());
  if (count > 0) {
    return SerialRead{.size = static_cast<std::size_t>(count),
                      .last_byte_stamp = clock_.now(),
                      .source = StampSource::read};
  }
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) { return Status::not_ready; }
  lose_device();
  return Status::disconnected;
}

Result<std::size_t> TermiosSerialPort::write(std::span<const std::uint8_t> bytes) {
  if (!device_.is_open()) { return Status::disconnected; }
  if (bytes.empty()) { return std::size_t{0}; }
  const ssize_t count = ::write(device_.get(), bytes.data(), bytes.size());
  if (count > 0) { return static_cast<std::size_t>(count); }
  if (count == 0 || errno == EAGAIN || errno == EINTR) { return Status::full; }
  lose_device();
  return Status::disconnected;
}

std::uint32_t TermiosSerialPort::lost() const {
  return lost_before_ + (device_.is_open() ? overruns() - overruns_at_open_ : 0);
}

std::uint32_t TermiosSerialPort::overruns() const {
  serial_icounter_struct counters{};
  if (::ioctl(device_.get(), TIOCGICOUNT, &counters) != 0) { return 0; }
  return static_cast<std::uint32_t>(counters.overrun) +
         static_cast<std::uint32_t>(counters.buf_overrun);
}

bool TermiosSerialPort::low_latency() const {
  serial_struct settings{};
  return ::ioctl(device_.get(), TIOCGSERIAL, &settings) == 0 && (settings.flags & kLowLatency) != 0;
}

void TermiosSerialPort::lose_device() {
  lost_before_ = lost();
  device_.close();
  ++disconnects_;
  next_try_ = clock_.now() + config_.retry_period;
}

}  // namespace picolo::inline v0
