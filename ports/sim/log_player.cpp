// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/log_player.hpp"

#include <algorithm>

namespace picolo::inline v0::sim {
namespace {

constexpr Duration kStep = 1ms;
constexpr std::int64_t kPointsPerSecond = 4500;
constexpr std::int32_t kLeadInBegin = 16'800;  // the lidar wakes up behind; 16 packets to 360 deg
constexpr std::int32_t kLeadInWidth = 1200;
constexpr std::int32_t kTurn = 36'000;

Duration point_time(std::int64_t point) {
  return Duration{point * 1'000'000 / kPointsPerSecond};
}

Pose2d first_pose(std::span<const LogStep> steps) {
  return steps.empty() ? Pose2d{} : steps.front().odom_T_base;
}

Ld06Packet empty_packet(std::int32_t start_cdeg) {
  const std::int32_t end_cdeg = (start_cdeg + kLeadInWidth * 11 / 12) % kTurn;
  return {.start_cdeg = static_cast<std::uint16_t>(start_cdeg % kTurn),
          .end_cdeg = static_cast<std::uint16_t>(end_cdeg)};
}

}  // namespace

EncoderReading LogPlayer::Shaft::reading_at(Timestamp instant) {
  return {.counts = script_.counts_at(instant)[wheel_],
          .counts_per_s = script_.rates_at(instant)[wheel_]};
}

LogPlayer::LogPlayer(const LogPlayerConfig& config, std::span<const LogStep> steps)
    : config_(config),
      steps_(steps),
      clock_(config.start),
      cycle_counter_(clock_),
      watchdog_(clock_, config.watchdog_period),
      can_(clock_, config.can_bit_rate),
      lidar_port_(clock_, kLd06Baud),
      faults_(config.seed, config.faults),
      script_(config.script, first_pose(steps)),
      left_shaft_(script_, 0),
      right_shaft_(script_, 1),
      wheels_(config.wheels, left_shaft_, right_shaft_, can_, faults_, config.start),
      lidar_link_(lidar_port_, faults_, Device::lidar, config.start),
      lived_until_(config.start),
      phase_end_(config.start + config.start_up) {
  if (steps_.empty()) { phase_ = Phase::finished; }
}

void LogPlayer::advance_to(Timestamp now) {
  while (lived_until_ < now) { live_one_step(); }
  clock_.set(now);
}

void LogPlayer::live_one_step() {
  lived_until_ += kStep;
  lidar_link_.update(lived_until_);
  wheels_.advance_to(lived_until_);
  if (phase_ == Phase::scanning) { send_packet(); }
  // Phases begin and end at whole steps, so that no step sees two ways of the wheels.
  if (lived_until_ < phase_end_) { return; }
  switch (phase_) {
    case Phase::moving: enter_scan(); break;
    case Phase::scanning: break;  // ends with its last packet
    case Phase::thinking: leave_thinking(); break;
    case Phase::finished: break;
  }
}

void LogPlayer::enter_scan() {
  phase_ = Phase::scanning;
  scan_begin_ = lived_until_;
  points_sent_ = 0;
  lead_in_cdeg_ = kLeadInBegin;
  revolution_begun_ = false;
  lead_out_sent_ = false;
  beams_.load(steps_[step_].beams);
}

/// At most one packet a step: packets are 2.7 ms apart.
void LogPlayer::send_packet() {
  const Timestamp measured = scan_begin_ + point_time(points_sent_ + std::int64_t{kLd06Points} - 1);
  if (measured > lived_until_) { return; }
  Ld06Packet packet;
  if (!next_packet(packet)) {
    leave_scan();
    return;
  }
  const auto device_ms = (measured - config_.start) / 1ms % 30'000;
  packet.stamp_ms = static_cast<std::uint16_t>(device_ms);
  lidar_link_.send(encode(packet), measured);
  points_sent_ += std::int64_t{kLd06Points};
}

bool LogPlayer::next_packet(Ld06Packet& packet) {
  const Timestamp first_point = scan_begin_ + point_time(points_sent_);
  if (lead_in_cdeg_ < kTurn) {
    packet = empty_packet(lead_in_cdeg_);
    lead_in_cdeg_ += kLeadInWidth;
    return true;
  }
  if (!revolution_begun_) {
    revolution_begun_ = true;
    window_ = {.step = step_, .begin = first_point, .end = Timestamp::max() - kStep};
  }
  if (beams_.next(packet)) { return true; }
  if (lead_out_sent_) { return false; }
  window_.end = first_point;
  packet = empty_packet(0);
  lead_out_sent_ = true;
  return true;
}

void LogPlayer::leave_scan() {
  if (windows_.room() == 0) { windows_.pop(); }
  static_cast<void>(windows_.push(window_));
  ++steps_played_;
  phase_ = Phase::thinking;
  phase_end_ = lived_until_ + config_.think_time;
}

void LogPlayer::leave_thinking() {
  ++step_;
  if (step_ == steps_.size()) {
    phase_ = Phase::finished;
    return;
  }
  phase_ = Phase::moving;
  phase_end_ = script_.go(steps_[step_].odom_T_base, lived_until_);
}

Result<std::size_t> LogPlayer::step_at(Timestamp instant) const {
  const auto contains = [&](const Window& window) {
    return instant >= window.begin - kStep && instant < window.end + kStep;
  };
  if (phase_ == Phase::scanning && revolution_begun_ && contains(window_)) { return window_.step; }
  for (std::size_t i = 0; i < windows_.size(); ++i) {
    if (contains(windows_[i])) { return windows_[i].step; }
  }
  return Status::out_of_range;
}

}  // namespace picolo::inline v0::sim
