// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/rplidar/rplidar.hpp"

#include <algorithm>

namespace picolo::inline v0 {
namespace {

constexpr Duration kSettle = 20ms;  // a stopped device needs it before it listens again
constexpr std::uint8_t kInfoType = 0x04;
constexpr std::uint8_t kHealthType = 0x06;

RplidarMode capsule_mode(RplidarMode mode) {
  return mode == RplidarMode::standard ? RplidarMode::express : mode;
}

}  // namespace

RplidarProtocol::RplidarProtocol(const RplidarConfig& config)
    : config_(config),
      capsules_(capsule_mode(config.mode)),
      timeline_(config.samples_per_second),
      mode_(config.mode),
      step_(config.active ? Step::stop : Step::scanning) {}

void RplidarProtocol::enter(Step step, Timestamp deadline) {
  step_ = step;
  deadline_ = deadline;
  bytes_since_step_ = 0;
}

void RplidarProtocol::start_over(Timestamp now, RplidarTrouble trouble) {
  trouble_ = trouble;
  ++restarts_;
  enter(Step::stop, now);
}

void RplidarProtocol::interrupted() {
  standard_.reset();
  capsules_.reset(capsule_mode(mode_));
  answer_length_ = 0;
  if (config_.active && step_ != Step::resting) { enter(Step::stop, Timestamp::min()); }
}

void RplidarProtocol::descriptor(const RplidarDescriptor& descriptor, Timestamp now) {
  answer_size_ = 0;
  answer_length_ = descriptor.mode == 0 ? descriptor.length : 0;
  answer_type_ = descriptor.type;
  if (descriptor.mode == 0) { return; }
  // A stream begins here, whatever was believed before.
  mode_ = static_cast<RplidarMode>(descriptor.type);
  standard_.reset();
  capsules_.reset(capsule_mode(mode_));
  if (step_ != Step::resting) { enter(Step::scanning, now + config_.silence_timeout); }
}

void RplidarProtocol::answer(std::uint8_t byte) {
  answer_[answer_size_] = byte;
  ++answer_size_;
  if (answer_size_ < answer_length_) { return; }
  answer_length_ = 0;
  if (answer_type_ == kInfoType) {
    info_ = {.model = answer_[0],
             .firmware_minor = answer_[1],
             .firmware_major = answer_[2],
             .hardware = answer_[3]};
    std::copy_n(answer_.begin() + 4, info_.serial_number.size(), info_.serial_number.begin());
    if (step_ == Step::await_info) { step_ = Step::health; }
  } else if (answer_type_ == kHealthType) {
    health_ = answer_[0] <= 2 ? static_cast<RplidarHealth>(answer_[0]) : RplidarHealth::unknown;
    if (step_ == Step::await_health) { step_ = Step::motor; }
  }
}

void RplidarProtocol::decode(std::uint8_t byte) {
  node_count_ = 0;
  if (mode_ == RplidarMode::standard) {
    if (!is_ok(standard_.push(byte))) { return; }
    nodes_[0] = standard_.node();
    node_count_ = 1;
  } else {
    node_count_ = capsules_.push(byte, nodes_);
  }
}

/// A standard node was sent as soon as it was measured. A capsule too, but its nodes are known only
/// when its successor has come: they were measured before its own first bit.
Timestamp RplidarProtocol::measured_before(const ByteTime& time) {
  if (mode_ == RplidarMode::standard) {
    return time.first_bit(RplidarStandardDecoder::kNodeSize + standard_.bytes_after_node());
  }
  const std::size_t completed = capsules_.completed_bytes();
  if (completed > 0) { completed_begin_ = time.first_bit(completed); }
  const Timestamp previous = capsule_begin_;
  if (capsules_.counters().frames != capsules_taken_) {
    capsules_taken_ = capsules_.counters().frames;
    capsule_begin_ = completed_begin_;
  }
  return previous;
}

std::size_t RplidarProtocol::push(std::uint8_t byte, const ByteTime& time,
                                  std::span<RangeReading> readings) {
  ++bytes_since_step_;
  node_count_ = 0;
  if (descriptors_.push(byte)) {
    descriptor(descriptors_.found(), time.arrived);
    return 0;
  }
  if (answer_length_ > 0) {
    answer(byte);
    return 0;
  }
  if (step_ != Step::scanning) { return 0; }
  decode(byte);
  const Timestamp end = measured_before(time);
  if (node_count_ == 0) { return 0; }
  bytes_since_step_ = 0;
  trouble_ = RplidarTrouble::none;
  deadline_ = time.arrived + config_.silence_timeout;
  samples_ += static_cast<std::uint32_t>(node_count_);
  for (std::size_t i = 0; i < node_count_; ++i) { to_reading(nodes_[i], readings[i]); }
  timeline_.stamp(end - config_.latency, readings.first(node_count_));
  return node_count_;
}

std::size_t RplidarProtocol::flush() {
  node_count_ = 0;
  if (mode_ == RplidarMode::standard && is_ok(standard_.flush())) {
    nodes_[0] = standard_.node();
    node_count_ = 1;
  }
  return node_count_;
}

std::size_t RplidarProtocol::motor_request(std::uint16_t value, std::span<std::uint8_t> out) const {
  std::array<std::uint8_t, 2> payload{};
  store_u16_le(payload, 0, value);
  switch (config_.motor) {
    case RplidarMotor::automatic: return 0;
    case RplidarMotor::pwm: return encode_rplidar(RplidarCommand::motor_pwm, payload, out);
    case RplidarMotor::rpm: return encode_rplidar(RplidarCommand::motor_rpm, payload, out);
  }
  return 0;
}

std::size_t RplidarProtocol::scan_request(std::span<std::uint8_t> out) const {
  if (config_.mode == RplidarMode::standard) {
    return encode_rplidar(RplidarCommand::scan, {}, out);
  }
  const std::array<std::uint8_t, 5> payload{config_.express_mode};
  return encode_rplidar(RplidarCommand::express_scan, payload, out);
}

std::size_t RplidarProtocol::request(Timestamp now, std::span<std::uint8_t> out) {
  if (!config_.active) { return 0; }
  const bool late = now >= deadline_;
  const RplidarTrouble no_answer =
      bytes_since_step_ == 0 ? RplidarTrouble::no_bytes : RplidarTrouble::no_descriptor;
  switch (step_) {
    case Step::stop: {
      enter(Step::settle, now + kSettle);
      return encode_rplidar(RplidarCommand::stop, {}, out);
    }
    case Step::settle:
      if (!late) { return 0; }
      [[fallthrough]];
    case Step::info:
      enter(Step::await_info, now + config_.answer_timeout);
      return encode_rplidar(RplidarCommand::info, {}, out);
    case Step::health:
      enter(Step::await_health, now + config_.answer_timeout);
      return encode_rplidar(RplidarCommand::health, {}, out);
    case Step::await_info:
    case Step::await_health:
    case Step::await_scan:
      if (late) { start_over(now, no_answer); }
      return 0;
    case Step::motor: {
      if (health_ == RplidarHealth::error) {
        start_over(now, RplidarTrouble::unhealthy);
        return 0;
      }
      enter(Step::scan, now);
      return motor_request(config_.motor_value, out);
    }
    case Step::scan:
      enter(Step::await_scan, now + config_.answer_timeout);
      return scan_request(out);
    case Step::scanning:
      if (late) {
        start_over(now,
                   bytes_since_step_ == 0 ? RplidarTrouble::no_bytes : RplidarTrouble::no_nodes);
      }
      return 0;
    case Step::resting: return 0;
  }
  return 0;
}

std::size_t RplidarProtocol::farewell(std::span<std::uint8_t> out) {
  step_ = Step::resting;
  const std::size_t stop = encode_rplidar(RplidarCommand::stop, {}, out);
  return stop + motor_request(0, out.subspan(stop));
}

SerialCounters RplidarProtocol::counters() const {
  const FramerCounters& nodes = standard_.counters();
  const FramerCounters& capsules = capsules_.counters();
  return {.frames = nodes.frames + capsules.frames,
          .bad_checksums = nodes.bad_checksums + capsules.bad_checksums,
          .implausible = nodes.implausible + capsules.implausible + capsules_.implausible(),
          .skipped_bytes = nodes.skipped_bytes + capsules.skipped_bytes,
          .samples = samples_,
          .restarts = restarts_};
}

}  // namespace picolo::inline v0
