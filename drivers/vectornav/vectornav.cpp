// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/vectornav/vectornav.hpp"

#include <algorithm>

#include "picolo/core/number_model.hpp"
#include "picolo/drivers/common/full_scale.hpp"

namespace picolo::inline v0 {

bool VectornavProtocol::to_sample(Timestamp sent, StampSource source, ImuSample& sample) {
  if (!data_.rate_radps || !data_.acceleration_mps2) { return false; }
  sample = {.stamp = sent, .source = source};
  if (config_.use_device_clock && data_.time_startup_ns) {
    constexpr std::uint64_t kWrapUs = std::uint64_t{1} << 50U;
    const auto device_us = static_cast<std::int64_t>(*data_.time_startup_ns / 1000U % kWrapUs);
    sample.stamp = clock_.map(sent, Duration{device_us});
    sample.source = StampSource::device;
  }
  sample.stamp = std::max(sample.stamp, last_stamp_);
  last_stamp_ = sample.stamp;
  sample.acceleration_mps2 = *data_.acceleration_mps2;
  sample.rate_radps = *data_.rate_radps;
  sample.saturated = beyond(sample.rate_radps, config_.rate_full_scale_radps) ||
                     beyond(sample.acceleration_mps2, config_.acceleration_full_scale_mps2);
  ++counters_.samples;
  if (sample.saturated) { ++counters_.saturated; }
  return true;
}

std::size_t VectornavProtocol::push(std::uint8_t byte, const ByteTime& time,
                                    std::span<ImuSample> samples) {
  data_ready_ = false;
  std::size_t written = 0;
  framer_.push(byte);
  while (framer_.next()) {
    const Result<VectornavData> data = parse_vectornav(framer_.frame());
    if (data.status() == Status::unsupported) { continue; }
    if (!data || data->damaged) {
      ++counters_.implausible;
      continue;
    }
    data_ = *data;
    data_ready_ = true;
    const std::size_t back = framer_.frame().size() + framer_.bytes_after_frame();
    if (written < samples.size() &&
        to_sample(time.first_bit(back), time.source, samples[written])) {
      ++written;
    }
  }
  return written;
}

SerialCounters VectornavProtocol::counters() const {
  SerialCounters counters = with_framer(counters_, framer_.counters());
  counters.clock_restarts = clock_.restarts();
  return counters;
}

}  // namespace picolo::inline v0
