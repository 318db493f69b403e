// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Any bytes into the decoders of serial devices.
#include <array>

#include "picolo/core/math.hpp"
#include "picolo/drivers/bno08x/bno08x_rvc.hpp"
#include "picolo/drivers/ld06/ld06_decoder.hpp"
#include "picolo/drivers/ld06/ld06_timeline.hpp"
#include "picolo/drivers/rplidar/rplidar.hpp"
#include "picolo/drivers/scip/scip.hpp"
#include "picolo/drivers/vectornav/vectornav.hpp"
#include "picolo/drivers/witmotion/witmotion_group.hpp"
#include "picolo/drivers/xsens/xsens.hpp"
#include "picolo/drivers/ydlidar/ydlidar.hpp"
#include "targets.hpp"

namespace picolo::fuzz {
namespace {

constexpr std::uint32_t kBaud = 250'000;

void judge(const RangeReading& reading, Timestamp& last) {
  require(reading.stamp >= last, "stamps of a lidar run backwards");
  require(is_finite(reading.range_m) && reading.range_m >= 0.0F && reading.range_m < 1000.0F,
          "an impossible range");
  require(reading.bearing_rad >= -3.1416F && reading.bearing_rad <= 3.1416F,
          "a bearing out of its range");
  last = reading.stamp;
}

void judge(const ImuSample& sample, Timestamp& last) {
  require(sample.stamp >= last, "stamps of an IMU run backwards");
  for (std::size_t i = 0; i < 3; ++i) {
    require(is_finite(sample.rate_radps[i]) && is_finite(sample.acceleration_mps2[i]),
            "an IMU sample that is no number");
  }
  last = sample.stamp;
}

/// Every byte once; what comes out is sound, and no more than the bytes can hold.
template <typename Protocol>
void feed(Protocol& protocol, Input bytes, std::size_t min_bytes_per_sample) {
  std::array<typename Protocol::Sample, Protocol::kMaxSamplesPerByte> samples{};
  Timestamp last = Timestamp::min();
  std::size_t position = 0;
  std::size_t total = 0;
  for (const std::uint8_t byte : bytes) {
    ++position;
    const ByteTime time{.arrived = Timestamp{1s} + transmission_time(position, kBaud),
                        .baud = kBaud};
    std::size_t count = protocol.push(byte, time, samples);
    require(count <= samples.size(), "more samples than announced");
    for (std::size_t i = 0; i < count; ++i) { judge(samples[i], last); }
    if constexpr (PullProtocol<Protocol>) {
      for (std::size_t more = protocol.pull(samples); more > 0; more = protocol.pull(samples)) {
        for (std::size_t i = 0; i < more; ++i) { judge(samples[i], last); }
        count += more;
      }
    }
    total += count;
  }
  require(total * min_bytes_per_sample <= bytes.size() * 2 + 1000, "samples out of nothing");
  const SerialCounters counters = protocol.counters();
  require(counters.skipped_bytes <= bytes.size() + 1, "more bytes skipped than came");
  if constexpr (CommandedProtocol<Protocol>) {
    std::array<std::uint8_t, Protocol::kMaxRequest> request{};
    Timestamp now{2s};
    for (int i = 0; i < 4; ++i, now += 600ms) {
      require(protocol.request(now, request) <= request.size(), "a request beyond its buffer");
    }
    require(protocol.farewell(request) <= request.size(), "a farewell beyond its buffer");
  }
  protocol.interrupted();
}

void ld06(Input input) {
  Ld06Decoder decoder;
  Ld06Readings convert;
  Ld06Timeline timeline;
  std::array<RangeReading, kLd06PointsPerPacket> readings{};
  Timestamp last = Timestamp::min();
  std::size_t position = 0;
  for (const std::uint8_t byte : input) {
    ++position;
    if (!is_ok(decoder.push(byte))) { continue; }
    convert.convert(decoder.packet(), readings);
    timeline.stamp(Timestamp{1s} + transmission_time(position, kBaud),
                   decoder.packet().timestamp_ms, readings);
    for (const RangeReading& reading : readings) { judge(reading, last); }
  }
  const FramerCounters& counters = decoder.counters();
  require(counters.frames * kLd06PacketSize + counters.skipped_bytes + decoder.pending() ==
              input.size(),
          "bytes are not accounted for");
}

void rplidar(Input input) {
  Reader reader{input};
  constexpr std::array<RplidarMode, 4> kModes{RplidarMode::standard, RplidarMode::express,
                                              RplidarMode::ultra, RplidarMode::dense};
  const std::uint8_t choice = reader.byte();
  RplidarProtocol protocol{{.mode = kModes[choice & 3U], .active = (choice & 4U) != 0}};
  feed(protocol, reader.rest(), 1);
  while (protocol.flush() > 0) {}
}

void scip(Input input) {
  ScipProtocol protocol{{.active = false}};
  feed(protocol, input, 1);
}

void ydlidar(Input input) {
  Reader reader{input};
  const std::uint8_t choice = reader.byte();
  constexpr std::array<std::uint8_t, 4> kWidths{0, 2, 3, 0};
  YdlidarProtocol protocol{{.sample_bytes = kWidths[choice & 3U],
                            .optics = static_cast<YdlidarOptics>((choice >> 2U) % 3U),
                            .active = false}};
  feed(protocol, reader.rest(), 2);
}

void witmotion(Input input) {
  WitMotionDecoder decoder;
  WitMotionGroup group;
  Timestamp last = Timestamp::min();
  std::size_t position = 0;
  for (const std::uint8_t byte : input) {
    ++position;
    if (!is_ok(decoder.push(byte))) { continue; }
    const auto sample =
        group.add(decoder.frame(), Timestamp{1s} + transmission_time(position, kBaud), 440us,
                  StampSource::read);
    if (sample) { judge(*sample, last); }
  }
  require(decoder.counters().frames * kWitMotionFrameSize + decoder.counters().skipped_bytes +
                  decoder.pending() ==
              input.size(),
          "bytes are not accounted for");
}

void bno08x(Input input) {
  Bno08xRvcProtocol protocol;
  feed(protocol, input, 19);
}

void xsens(Input input) {
  XsensProtocol protocol;
  feed(protocol, input, 8);
}

void vectornav(Input input) {
  VectornavProtocol protocol;
  feed(protocol, input, 10);
}

}  // namespace

std::vector<Target> serial_targets() {
  return {{"ld06", ld06, true},       {"rplidar", rplidar, true},     {"scip", scip, true},
          {"ydlidar", ydlidar, true}, {"witmotion", witmotion, true}, {"bno08x-rvc", bno08x, true},
          {"xsens", xsens, true},     {"vectornav", vectornav, true}};
}

}  // namespace picolo::fuzz
