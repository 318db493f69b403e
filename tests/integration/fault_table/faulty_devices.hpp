// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Devices between a driver, or a player of a log, and the controller, that spoil samples.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "fault.hpp"
#include "picolo/controller/devices.hpp"
#include "picolo/hal/clock.hpp"

namespace picolo::test {

/// Both wheels come in one sample: one that is off takes the sample with it, as with two CAN nodes
/// of which one says nothing, or shows 0 (second variant).
template <WheelDevice W>
class FaultyWheels {
 public:
  explicit FaultyWheels(W& wheels) : wheels_(wheels) {}
  void inject(const Fault& fault) { state_.set(fault); }

  bool consume(const CanFrame& frame) { return wheels_.consume(frame); }
  Status service(Timestamp now) { return wheels_.service(now); }
  Result<WheelTicks> take() {
    const Result<WheelTicks> sound = wheels_.take();
    if (!sound) { return sound; }
    WheelTicks ticks = *sound;
    for (const Sensor sensor : {Sensor::left_wheel, Sensor::right_wheel}) {
      if (!spoil(sensor, *sound, ticks)) {
        remember(*sound);
        return Status::not_ready;
      }
    }
    remember(*sound);
    return ticks;
  }

 private:
  static constexpr double kWildCounts = 2e9;
  static constexpr double kPlausibleCounts = 100.0;  // 1.5 m/s of the simulated vehicle's wheels

  // False: no sample at all.
  bool spoil(Sensor sensor, const WheelTicks& sound, WheelTicks& ticks) {
    const auto wheel = static_cast<std::size_t>(sensor);
    if (!history_.empty() && lost_[wheel] != 0) { ticks.ticks[wheel] += lost_[wheel]; }
    if (!state_.holds(sensor, sound.stamp) || history_.empty()) { return true; }
    const std::int64_t step = sound.ticks[wheel] - history_.back().ticks[wheel];
    std::int64_t& count = ticks.ticks[wheel];
    switch (state_.fault().kind) {
      case Kind::off:
        if (!state_.second_variant()) { return false; }
        count = 0;
        break;
      case Kind::stuck: count = kept(wheel); break;
      case Kind::garbage:
        if (state_.second_variant()) {
          lost_[wheel] +=
              std::llround(state_.random().uniform(-kPlausibleCounts, kPlausibleCounts));
          count = sound.ticks[wheel] + lost_[wheel];
        } else {
          count = std::llround(state_.random().uniform(-kWildCounts, kWildCounts));
        }
        break;
      case Kind::wrong_scale:
        lost_exact_ += static_cast<double>(step) * (state_.scale() - 1.0);
        lost_[wheel] = std::llround(lost_exact_);
        count = sound.ticks[wheel] + lost_[wheel];
        break;
      case Kind::slow:
        if (samples_++ % state_.every() == 0) { kept_[wheel] = sound.ticks[wheel]; }
        count = kept_[wheel];
        break;
      case Kind::delayed: count = at(sound.stamp - state_.delay()).ticks[wheel]; break;
      case Kind::intermittent: return !state_.gone(sound.stamp);
    }
    return true;
  }
  [[nodiscard]] const WheelTicks& at(Timestamp stamp) const {
    for (std::size_t k = history_.size(); k > 0; --k) {
      if (history_[k - 1].stamp <= stamp) { return history_[k - 1]; }
    }
    return history_.front();
  }
  [[nodiscard]] std::int64_t kept(std::size_t wheel) {
    if (samples_++ == 0) { kept_[wheel] = history_.back().ticks[wheel]; }
    return kept_[wheel];
  }
  void remember(const WheelTicks& ticks) {
    history_.push_back(ticks);
    if (history_.size() > 64) { history_.pop_front(); }
  }

  W& wheels_;
  FaultState state_;
  std::deque<WheelTicks> history_;  // sound ones
  std::array<std::int64_t, 2> lost_{};
  std::array<std::int64_t, 2> kept_{};
  double lost_exact_ = 0.0;
  int samples_ = 0;
};

/// Samples that wait until a stream that runs late hands them over.
template <typename Sample>
class LateQueue {
 public:
  void push(const Sample& sample, Timestamp release) { held_.push_back({release, sample}); }
  std::size_t pop(Timestamp now, std::span<Sample> out) {
    std::size_t count = 0;
    while (count < out.size() && !held_.empty() && held_.front().first <= now) {
      out[count++] = held_.front().second;
      held_.pop_front();
    }
    return count;
  }

 private:
  std::deque<std::pair<Timestamp, Sample>> held_;
};

/// A device that reads its driver into a queue, spoiled.
template <typename Sample>
[[nodiscard]] Result<std::size_t> hand_over(const Result<std::size_t>& read,
                                            LateQueue<Sample>& queue, Timestamp now,
                                            std::span<Sample> out) {
  const std::size_t count = queue.pop(now, out);
  if (count == 0 && !read) { return read.status(); }
  return count;
}

template <LidarDevice L>
class FaultyLidar {
 public:
  FaultyLidar(L& lidar, Clock& clock) : lidar_(lidar), clock_(clock) {}
  void inject(const Fault& fault) {
    state_.set(fault);
    frozen_m_ = last_sweep_m_;
  }

  Result<std::size_t> poll(std::size_t max_bytes, std::span<RangeReading> readings) {
    std::array<RangeReading, 48> read{};
    const auto room = std::min(read.size(), readings.size());
    const Result<std::size_t> count = lidar_.poll(max_bytes, std::span{read}.first(room));
    for (std::size_t i = 0; i < count.value_or(0); ++i) { spoil(read[i]); }
    return hand_over(count, queue_, clock_.now(), readings);
  }

 private:
  static constexpr double kMaxRange_m = 12.0;

  void spoil(const RangeReading& sound) {
    if (sound.starts_sweep) {
      last_sweep_m_.swap(sweep_m_);
      sweep_m_.clear();
      ++sweeps_;
    }
    const std::size_t index = sweep_m_.size();
    sweep_m_.push_back(sound.range_m);
    RangeReading reading = sound;
    Timestamp release = sound.stamp;
    if (state_.holds(Sensor::lidar, sound.stamp)) {
      if (!apply(sound, index, reading)) { return; }
      if (state_.fault().kind == Kind::delayed) {
        reading.stamp += state_.delay();
        release = clock_.now() + state_.delay();
      }
    }
    queue_.push(reading, release);
  }

  // False: the reading never comes.
  bool apply(const RangeReading& sound, std::size_t index, RangeReading& reading) {
    switch (state_.fault().kind) {
      case Kind::off: reading.range_m = 0.0F; return state_.second_variant();
      case Kind::stuck:
        reading.range_m = index < frozen_m_.size() ? frozen_m_[index] : 0.0F;
        return true;
      case Kind::garbage:
        if (!state_.second_variant() || state_.random().below(2) == 0) {
          reading.range_m = static_cast<float>(state_.random().uniform(0.05, kMaxRange_m));
        }
        return true;
      case Kind::wrong_scale:
        reading.range_m = sound.range_m * static_cast<float>(state_.scale());
        return true;
      case Kind::slow: {
        // Of the next revolution the first reading comes: it ends the one that came.
        const int phase = sweeps_ % state_.every();
        return phase == 0 || (phase == 1 && sound.starts_sweep);
      }
      case Kind::delayed: return true;
      case Kind::intermittent: return !state_.gone(sound.stamp);
    }
    return true;
  }

  L& lidar_;
  Clock& clock_;
  FaultState state_;
  LateQueue<RangeReading> queue_;
  std::vector<float> sweep_m_;
  std::vector<float> last_sweep_m_;
  std::vector<float> frozen_m_;
  int sweeps_ = 0;
};

/// Gyro and accelerometer of one device: a spoiled one leaves the other sound, except where whole
/// samples do not come. `tilt`: from an instant on the vehicle leans to its left.
template <ImuDevice I>
class FaultyImu {
 public:
  FaultyImu(I& imu, Clock& clock) : imu_(imu), clock_(clock) {}
  void inject(const Fault& fault) { state_.set(fault); }
  void tilt(Timestamp from, Timestamp to, float angle_rad) {
    tilt_from_ = from;
    tilt_to_ = to;
    tilt_rad_ = angle_rad;
  }

  Result<std::size_t> poll(std::size_t max_bytes, std::span<ImuSample> samples) {
    std::array<ImuSample, 8> read{};
    const auto room = std::min(read.size(), samples.size());
    const Result<std::size_t> count = imu_.poll(max_bytes, std::span{read}.first(room));
    for (std::size_t i = 0; i < count.value_or(0); ++i) { spoil(leaning(read[i])); }
    return hand_over(count, queue_, clock_.now(), samples);
  }

 private:
  using Axes = std::array<float, 3>;

  [[nodiscard]] ImuSample leaning(ImuSample sample) const {
    if (sample.stamp < tilt_from_ || sample.stamp >= tilt_to_) { return sample; }
    const float y = sample.acceleration_mps2[1];
    const float z = sample.acceleration_mps2[2];
    sample.acceleration_mps2[1] = y * std::cos(tilt_rad_) + z * std::sin(tilt_rad_);
    sample.acceleration_mps2[2] = z * std::cos(tilt_rad_) - y * std::sin(tilt_rad_);
    return sample;
  }

  void spoil(const ImuSample& sound) {
    ImuSample sample = sound;
    Timestamp release = sound.stamp;
    bool comes = true;
    if (state_.holds(Sensor::gyro, sound.stamp)) {
      comes = apply(sound.rate_radps, &ImuSample::rate_radps, sample.rate_radps, 30.0, 0.5);
      if (state_.fault().kind == Kind::delayed) {
        sample.stamp += state_.delay();
        release = clock_.now() + state_.delay();
      }
      if (state_.fault().kind == Kind::slow) { comes = samples_++ % state_.every() == 0; }
    } else if (state_.holds(Sensor::accelerometer, sound.stamp)) {
      comes = apply(sound.acceleration_mps2, &ImuSample::acceleration_mps2,
                    sample.acceleration_mps2, 150.0, 3.0);
      if (state_.fault().kind == Kind::delayed) {
        sample.acceleration_mps2 = at(sound.stamp - state_.delay()).acceleration_mps2;
      }
      if (state_.fault().kind == Kind::slow) {
        if (samples_++ % state_.every() == 0) { kept_ = sound.acceleration_mps2; }
        sample.acceleration_mps2 = kept_;
      }
    }
    history_.push_back(sound);
    if (history_.size() > 64) { history_.pop_front(); }
    if (comes) { queue_.push(sample, release); }
  }

  // False: the sample never comes.
  bool apply(const Axes& sound, Axes ImuSample::*axes, Axes& spoiled, double wild,
             double plausible) {
    switch (state_.fault().kind) {
      case Kind::off: spoiled = {}; return state_.second_variant();
      case Kind::stuck:
        if (samples_++ == 0) { kept_ = history_.empty() ? sound : history_.back().*axes; }
        spoiled = kept_;
        return true;
      case Kind::garbage: {
        const double size = state_.second_variant() ? plausible : wild;
        for (float& axis : spoiled) {
          axis = static_cast<float>(state_.random().uniform(-size, size));
        }
        return true;
      }
      case Kind::wrong_scale:
        for (float& axis : spoiled) { axis *= static_cast<float>(state_.scale()); }
        return true;
      case Kind::slow: return true;
      case Kind::delayed: return true;
      case Kind::intermittent:
        if (!state_.gone(history_.empty() ? Timestamp{} : history_.back().stamp)) { return true; }
        spoiled = {};
        return state_.second_variant();
    }
    return true;
  }
  [[nodiscard]] const ImuSample& at(Timestamp stamp) const {
    for (std::size_t k = history_.size(); k > 0; --k) {
      if (history_[k - 1].stamp <= stamp) { return history_[k - 1]; }
    }
    return history_.front();
  }

  I& imu_;
  Clock& clock_;
  FaultState state_;
  LateQueue<ImuSample> queue_;
  std::deque<ImuSample> history_;  // sound ones
  Axes kept_{};
  int samples_ = 0;
  Timestamp tilt_from_ = Timestamp::max();
  Timestamp tilt_to_ = Timestamp::max();
  float tilt_rad_ = 0.0F;
};

}  // namespace picolo::test
