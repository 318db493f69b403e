// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/xsens/xsens.hpp"

#include <algorithm>

#include "picolo/core/number_model.hpp"
#include "picolo/drivers/common/full_scale.hpp"

namespace picolo::inline v0 {
namespace {

/// Clipping of accelerometer (bits 8-10) and gyro (11-13), and of any (19).
constexpr std::uint32_t kClipped = 0x3F00U | (1U << 19U);
constexpr std::array<std::uint8_t, 5> kGoToMeasurement{0xFA, 0xFF, 0x10, 0x00, 0xF1};
constexpr std::array<std::uint8_t, 5> kGoToConfig{0xFA, 0xFF, 0x30, 0x00, 0xD1};

}  // namespace

void XsensProtocol::note_counter() {
  if (!data_.packet_counter) { return; }
  const std::uint16_t counter = *data_.packet_counter;
  const auto step = static_cast<std::uint16_t>(counter - last_counter_);
  if (has_counter_ && step > 1 && step < 0x8000U) { counters_.missed += step - 1U; }
  last_counter_ = counter;
  has_counter_ = true;
}

bool XsensProtocol::to_sample(Timestamp sent, StampSource source, ImuSample& sample) {
  if (data_.acceleration_mps2) { acceleration_mps2_ = *data_.acceleration_mps2; }
  if (!data_.rate_radps) { return false; }
  sample = {.stamp = sent, .source = source};
  if (config_.use_device_clock && data_.sample_time_100us) {
    sample.stamp = clock_.map(sent, Duration{std::int64_t{*data_.sample_time_100us} * 100});
    sample.source = StampSource::device;
  }
  sample.stamp = std::max(sample.stamp, last_stamp_);
  last_stamp_ = sample.stamp;
  sample.acceleration_mps2 = acceleration_mps2_;
  sample.rate_radps = *data_.rate_radps;
  sample.saturated = (data_.status.value_or(0) & kClipped) != 0 ||
                     beyond(sample.rate_radps, config_.rate_full_scale_radps) ||
                     beyond(sample.acceleration_mps2, config_.acceleration_full_scale_mps2);
  ++counters_.samples;
  if (sample.saturated) { ++counters_.saturated; }
  return true;
}

std::size_t XsensProtocol::push(std::uint8_t byte, const ByteTime& time,
                                std::span<ImuSample> samples) {
  data_ready_ = false;
  std::size_t written = 0;
  framer_.push(byte);
  while (framer_.next()) {
    deadline_ = time.arrived + config_.silence_timeout;
    if (xsens_message_id(framer_.frame()) != kXsensMtData2) { continue; }
    data_ = parse_xsens(framer_.frame());
    data_ready_ = true;
    if (data_.damaged) {
      ++counters_.implausible;
      continue;
    }
    note_counter();
    const std::size_t back = framer_.frame().size() + framer_.bytes_after_frame();
    if (written < samples.size() &&
        to_sample(time.first_bit(back), time.source, samples[written])) {
      ++written;
    }
  }
  return written;
}

std::size_t XsensProtocol::request(Timestamp now, std::span<std::uint8_t> out) {
  if (!config_.active || resting_ || now < deadline_) { return 0; }
  if (asked_) { ++counters_.restarts; }
  asked_ = true;
  deadline_ = now + config_.silence_timeout;
  std::copy(kGoToMeasurement.begin(), kGoToMeasurement.end(), out.begin());
  return kGoToMeasurement.size();
}

std::size_t XsensProtocol::farewell(std::span<std::uint8_t> out) {
  resting_ = true;
  std::copy(kGoToConfig.begin(), kGoToConfig.end(), out.begin());
  return kGoToConfig.size();
}

void XsensProtocol::interrupted() {
  framer_.reset();
  has_counter_ = false;
  deadline_ = Timestamp::min();
}

SerialCounters XsensProtocol::counters() const {
  SerialCounters counters = with_framer(counters_, framer_.counters());
  counters.clock_restarts = clock_.restarts();
  return counters;
}

}  // namespace picolo::inline v0
