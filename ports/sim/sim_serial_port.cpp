// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/sim_serial_port.hpp"

#include <algorithm>

namespace picolo::inline v0::sim {

SimSerialPort::SimSerialPort(Clock& clock, std::uint32_t baud) : clock_(clock), baud_(baud) {}

Result<SerialRead> SimSerialPort::read(std::span<std::uint8_t> buffer) {
  if (!connected_) { return Status::disconnected; }
  const Timestamp now = clock_.now();
  SerialRead result{.source = StampSource::hardware};
  while (result.size < buffer.size() && !bursts_.empty()) {
    const Burst burst = bursts_.front();
    const std::size_t ready = arrived(burst, now) - consumed_;
    const std::size_t count = std::min(ready, buffer.size() - result.size);
    if (count == 0) { break; }
    for (std::size_t i = 0; i < count; ++i) {
      buffer[result.size + i] = bytes_.front();
      bytes_.pop();
    }
    result.size += count;
    consumed_ += count;
    result.last_byte_stamp = burst.start + transmission_time(consumed_, baud_);
    if (consumed_ < burst.size) { continue; }
    bursts_.pop();
    consumed_ = 0;
  }
  if (result.size == 0) { return Status::not_ready; }
  return result;
}

Result<std::size_t> SimSerialPort::write(std::span<const std::uint8_t> bytes) {
  if (!connected_) { return Status::disconnected; }
  const std::size_t count = std::min(bytes.size(), written_.room());
  if (count == 0 && !bytes.empty()) { return Status::full; }
  for (const std::uint8_t byte : bytes.first(count)) { static_cast<void>(written_.push(byte)); }
  return count;
}

Timestamp SimSerialPort::deliver(std::span<const std::uint8_t> bytes, Timestamp earliest) {
  const Burst burst{.start = std::max(earliest, free_from_), .size = bytes.size()};
  free_from_ = burst.start + transmission_time(bytes.size(), baud_);
  if (!connected_ || bytes.empty()) { return free_from_; }
  if (bytes_.room() < bytes.size() || !bursts_.push(burst)) {
    lost_ += static_cast<std::uint32_t>(bytes.size());
    return free_from_;
  }
  for (const std::uint8_t byte : bytes) { static_cast<void>(bytes_.push(byte)); }
  return free_from_;
}

std::size_t SimSerialPort::take_written(std::span<std::uint8_t> buffer) {
  const std::size_t count = std::min(buffer.size(), written_.size());
  for (std::size_t i = 0; i < count; ++i) {
    buffer[i] = written_.front();
    written_.pop();
  }
  return count;
}

void SimSerialPort::set_connected(bool connected) {
  if (!connected) {
    bytes_.clear();
    bursts_.clear();
    written_.clear();
    consumed_ = 0;
  }
  connected_ = connected;
}

std::size_t SimSerialPort::arrived(const Burst& burst, Timestamp now) const {
  if (now < burst.start) { return 0; }
  // The largest count whose transmission_time, rounded down, is not after now.
  const std::int64_t limit = (now - burst.start).count() + 1;
  const std::int64_t count = (limit * std::int64_t{baud_} + 9'999'999) / 10'000'000 - 1;
  return static_cast<std::size_t>(
      std::clamp<std::int64_t>(count, 0, static_cast<std::int64_t>(burst.size)));
}

}  // namespace picolo::inline v0::sim
