// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/witmotion/witmotion.hpp"

#include <algorithm>

#include "picolo/drivers/common/serial_chunk.hpp"

namespace picolo::inline v0 {

WitMotion::WitMotion(SerialPort& port, const WitMotionConfig& config)
    : port_(port), group_(config.group) {}

Result<std::size_t> WitMotion::poll(std::size_t max_bytes, std::span<ImuSample> samples) {
  if (samples.empty()) { return Status::invalid_argument; }
  SerialChunk chunk;
  std::size_t written = 0;
  Status status = Status::not_ready;
  while (max_bytes > 0) {
    const std::size_t limit =
        bytes_for_frames(samples.size() - written, kWitMotionFrameSize, decoder_.pending());
    status = chunk.read(port_, std::min(limit, max_bytes));
    if (!is_ok(status)) { break; }
    max_bytes -= chunk.size();
    bytes_ += static_cast<std::uint32_t>(chunk.size());
    const Duration frame_time = transmission_time(kWitMotionFrameSize, port_.baud());
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      if (!is_ok(decoder_.push(chunk[i]))) { continue; }
      const auto sample = group_.add(decoder_.frame(), chunk.first_bit(i, kWitMotionFrameSize),
                                     frame_time, chunk.source());
      if (!sample) { continue; }
      samples[written] = *sample;
      ++written;
    }
  }
  if (written > 0) { return written; }
  return is_ok(status) ? Status::not_ready : status;
}

WitMotionCounters WitMotion::counters() const {
  const FramerCounters& framer = decoder_.counters();
  const WitMotionGroupCounters& group = group_.counters();
  return {.bytes = bytes_,
          .frames = framer.frames,
          .bad_checksums = framer.bad_checksums,
          .skipped_bytes = framer.skipped_bytes,
          .samples = group.samples,
          .incomplete = group.incomplete,
          .saturated = group.saturated};
}

}  // namespace picolo::inline v0
