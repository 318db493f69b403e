// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/ld06/ld06.hpp"

#include <algorithm>

#include "picolo/drivers/common/serial_chunk.hpp"

namespace picolo::inline v0 {

Ld06::Ld06(SerialPort& port, const Ld06Config& config)
    : port_(port),
      decoder_(config.format),
      readings_(config.readings),
      timeline_(config.timeline) {}

Result<std::size_t> Ld06::poll(std::size_t max_bytes, std::span<RangeReading> readings) {
  if (readings.size() < kLd06PointsPerPacket) { return Status::invalid_argument; }
  SerialChunk chunk;
  std::size_t written = 0;
  Status status = Status::not_ready;
  while (max_bytes > 0) {
    const std::size_t room = (readings.size() - written) / kLd06PointsPerPacket;
    const std::size_t limit = bytes_for_frames(room, kLd06PacketSize, decoder_.pending());
    status = chunk.read(port_, std::min(limit, max_bytes));
    if (!is_ok(status)) { break; }
    max_bytes -= chunk.size();
    bytes_ += static_cast<std::uint32_t>(chunk.size());
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      if (!is_ok(decoder_.push(chunk[i]))) { continue; }
      const auto packet_readings = readings.subspan(written).first<kLd06PointsPerPacket>();
      readings_.convert(decoder_.packet(), packet_readings);
      timeline_.stamp(chunk.first_bit(i, kLd06PacketSize), decoder_.packet().timestamp_ms,
                      packet_readings);
      written += kLd06PointsPerPacket;
    }
  }
  if (written > 0) { return written; }
  return is_ok(status) ? Status::not_ready : status;
}

Ld06Counters Ld06::counters() const {
  const FramerCounters& framer = decoder_.counters();
  return {.bytes = bytes_,
          .packets = framer.frames,
          .bad_checksums = framer.bad_checksums,
          .implausible = framer.implausible,
          .skipped_bytes = framer.skipped_bytes,
          .clock_restarts = timeline_.clock_restarts()};
}

}  // namespace picolo::inline v0
