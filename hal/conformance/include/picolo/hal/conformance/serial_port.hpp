// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every SerialPort must do.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/hal/conformance/checker.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::inline v0::conformance {

/// `inject`: the device sends bytes (at most 256 a call). `sent`: moves bytes that the port has
/// sent and that were not yet returned into the buffer, and says how many. `wait`: lets time pass.
/// `now`: the port's clock. Optional: `unplug()` and `plug()`.
template <typename H>
concept SerialPortHarness = requires(H& harness, std::span<const std::uint8_t> bytes,
                                     std::span<std::uint8_t> buffer, Duration duration) {
  { harness.port() } -> std::convertible_to<SerialPort&>;
  { harness.inject(bytes) } -> std::convertible_to<bool>;
  { harness.sent(buffer) } -> std::convertible_to<std::size_t>;
  { harness.now() } -> std::same_as<Timestamp>;
  harness.wait(duration);
};

namespace detail {

using AllBytes = std::array<std::uint8_t, 256>;

[[nodiscard]] constexpr AllBytes all_bytes() {
  AllBytes bytes{};
  for (std::size_t i = 0; i < bytes.size(); ++i) { bytes[i] = static_cast<std::uint8_t>(i); }
  return bytes;
}

/// Time for 256 bytes at the slowest rate that a device of picolo uses (9600 baud), with a margin.
inline constexpr Duration kLongEnough = 400ms;

/// Reads until nothing waits, `chunk` bytes at a time; returns how many were read and judges the
/// contracts of read.
template <SerialPortHarness Harness>
std::size_t serial_port_drain(Harness& harness, Checker& checker, std::span<std::uint8_t> out,
                              std::size_t chunk, Timestamp begin) {
  std::size_t total = 0;
  bool sizes_right = true;
  bool stamps_right = true;
  Timestamp last = begin;
  while (total < out.size()) {
    const std::size_t room = out.size() - total < chunk ? out.size() - total : chunk;
    const Result<SerialRead> read = harness.port().read(out.subspan(total, room));
    if (!read) { break; }
    if (read->size == 0 || read->size > room) {
      sizes_right = false;
      break;
    }
    stamps_right =
        stamps_right && read->last_byte_stamp >= last && read->last_byte_stamp <= harness.now();
    last = read->last_byte_stamp;
    total += read->size;
  }
  checker.expect(
      sizes_right, "SerialPort::read returns between 1 byte and the buffer's size, or not_ready",
      "answer not_ready, not a size of 0, when nothing waits; never write beyond the buffer");
  checker.expect(
      stamps_right, "last_byte_stamp never decreases and lies between the bytes' departure and now",
      "take the stamp where the bytes are taken from the hardware, on the port's own clock");
  return total;
}

template <SerialPortHarness Harness>
void serial_port_reads(Harness& harness, Checker& checker) {
  AllBytes got{};
  checker.expect(harness.port().read(got).status() == Status::not_ready,
                 "SerialPort::read answers not_ready while no byte waits",
                 "never block in read; VMIN and O_NONBLOCK on Linux");
  const AllBytes bytes = all_bytes();
  const bool one = harness.inject(std::span{bytes}.subspan(0x55, 1));
  harness.wait(kLongEnough);
  const Result<SerialRead> first = harness.port().read(got);
  if (!checker.expect(one && first && first->size == 1 && got[0] == 0x55,
                      "SerialPort::read delivers a byte that has arrived",
                      "let the receive interrupt push it into a ring and pop that in read; check "
                      "the baud rate, the pins and the interrupt's number")) {
    return;
  }
  for (const std::size_t chunk : {std::size_t{256}, std::size_t{7}, std::size_t{1}}) {
    got.fill(0);
    const Timestamp begin = harness.now();
    const bool injected = harness.inject(bytes);
    harness.wait(kLongEnough);
    checker.expect(harness.port().read({}).status() == Status::not_ready,
                   "SerialPort::read into an empty buffer answers not_ready",
                   "test the buffer's size first");
    const std::size_t total = serial_port_drain(harness, checker, got, chunk, begin);
    checker.expect(injected && total == bytes.size(),
                   "SerialPort holds at least 256 bytes between two reads and loses none",
                   "enlarge the receive ring; a missing 0x04, 0x11 or 0x13 means that the line is "
                   "not raw (cfmakeraw, no IXON)");
    checker.expect(got == bytes,
                   "SerialPort::read delivers all 256 byte values unchanged and in order",
                   "raw mode, 8N1: no echo, no ICRNL, no IXON, no ISTRIP");
  }
  checker.expect(harness.port().lost() == 0, "SerialPort::lost stays 0 while nothing is lost",
                 "count hardware overruns and a full ring only");
}

template <SerialPortHarness Harness>
void serial_port_writes(Harness& harness, Checker& checker) {
  const AllBytes bytes = all_bytes();
  AllBytes got{};
  std::size_t written = 0;
  std::size_t arrived = 0;
  bool counts_right = true;
  for (int turn = 0; turn < 256 && arrived < bytes.size(); ++turn) {
    const Result<std::size_t> taken = harness.port().write(std::span{bytes}.subspan(written));
    if (!taken && taken.status() != Status::full) { break; }
    if (taken) {
      counts_right = counts_right && *taken <= bytes.size() - written;
      written += counts_right ? *taken : 0;
    }
    harness.wait(kLongEnough);
    arrived += harness.sent(std::span{got}.subspan(arrived));
  }
  checker.expect(counts_right && written == bytes.size(),
                 "SerialPort::write returns how many bytes it took",
                 "at most as many as were given; full when none fitted");
  checker.expect(got == bytes, "SerialPort::write sends all 256 byte values unchanged and in order",
                 "raw mode: no OPOST, no ONLCR");
  AllBytes echo{};
  checker.expect(harness.port().read(echo).status() == Status::not_ready,
                 "what is written does not come back", "switch ECHO off");
}

template <SerialPortHarness Harness>
void serial_port_never_blocks(Harness& harness, Checker& checker) {
  const AllBytes bytes = all_bytes();
  Status status = Status::ok;
  for (int i = 0; i < 20'000 && is_ok(status); ++i) {
    status = harness.port().write(bytes).status();
  }
  checker.expect(status == Status::full,
                 "SerialPort::write answers full when nothing fits, and never blocks",
                 "bound the send queue; map EAGAIN to full");
  AllBytes sink{};
  for (int i = 0; i < 20'000; ++i) {
    if (harness.sent(sink) > 0) { continue; }
    harness.wait(kLongEnough);
    if (harness.sent(sink) == 0) { break; }
  }
  checker.expect(is_ok(harness.port().write(std::span{bytes}.first(1)).status()),
                 "SerialPort::write works again when the queue has drained",
                 "do not keep a full queue as an error state");
  harness.wait(kLongEnough);
  static_cast<void>(harness.sent(sink));
}

template <SerialPortHarness Harness>
void serial_port_comes_back(Harness& harness, Checker& checker) {
  AllBytes got{};
  harness.unplug();
  harness.wait(10ms);
  checker.expect(harness.port().read(got).status() == Status::disconnected,
                 "SerialPort::read answers disconnected while the device is gone",
                 "map EIO, ENODEV and end of file to disconnected");
  checker.expect(harness.port().write(got).status() == Status::disconnected,
                 "SerialPort::write answers disconnected while the device is gone", "as for read");
  harness.plug();
  harness.wait(10ms);
  Status status = Status::disconnected;
  for (int i = 0; i < 100 && status == Status::disconnected; ++i) {
    status = harness.port().read(got).status();
    harness.wait(50ms);
  }
  const AllBytes bytes = all_bytes();
  const Timestamp begin = harness.now();
  const bool injected = harness.inject(bytes);
  harness.wait(kLongEnough);
  const std::size_t total = serial_port_drain(harness, checker, got, got.size(), begin);
  checker.expect(injected && total == bytes.size() && got == bytes,
                 "SerialPort works again when the device has come back",
                 "open it again from read, at bounded intervals, and set the line up anew");
}

}  // namespace detail

/// Precondition: nothing waits in either direction.
template <SerialPortHarness Harness>
void check_serial_port(Harness& harness, Checker& checker) {
  checker.expect(harness.port().baud() > 0, "SerialPort::baud is never 0",
                 "return the configured rate, even for a virtual line");
  detail::serial_port_reads(harness, checker);
  detail::serial_port_writes(harness, checker);
  detail::serial_port_never_blocks(harness, checker);
  if constexpr (requires {
                  harness.unplug();
                  harness.plug();
                }) {
    detail::serial_port_comes_back(harness, checker);
  }
}

}  // namespace picolo::inline v0::conformance
