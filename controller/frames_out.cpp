// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/frames_out.hpp"

#include <limits>

#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr Duration kTick{250'000};
constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();

template <typename Enum>
std::int64_t code(Enum value) {
  return static_cast<std::int64_t>(value);
}

double sigma(float variance) {
  // A covariance that is no number must not look like certainty.
  return is_finite(variance) && variance >= 0.0F ? static_cast<double>(square_root(variance))
                                                 : kNotKnown;
}

double correlation_of(const Matrix3f& covariance, std::size_t row, std::size_t column) {
  const float product = covariance(row, row) * covariance(column, column);
  if (!is_finite(product) || product < 0.0F) { return kNotKnown; }
  // Below this the quotient is no use, and neither is the correlation.
  constexpr float kSmall = 1e-20F;
  if (product < kSmall) { return 0.0; }
  return static_cast<double>(covariance(row, column) / square_root(product));
}

}  // namespace

std::uint8_t can_tick(Timestamp now) {
  return static_cast<std::uint8_t>((now.time_since_epoch() / kTick) & 0xFF);
}

CanFrame FramesOut::next(const CanLayout& layout, Timestamp stamp,
                         std::span<const std::int64_t> raw) {
  std::uint8_t& counter = counters_[layout.offset];
  CanFrame frame = encode(layout, base_id_, counter, raw);
  frame.stamp = stamp;
  counter = static_cast<std::uint8_t>((counter + 1) % kCanCounterModulus);
  return frame;
}

CanFrame FramesOut::pose(const PoseEstimate& estimate) {
  const auto& signals = can_layout::kPose.fields;
  const std::array raw{to_raw(signals[0], estimate.map_T_base.x_m),
                       to_raw(signals[1], estimate.map_T_base.y_m),
                       to_raw(signals[2], estimate.map_T_base.theta_rad)};
  return next(can_layout::kPose, estimate.stamp, raw);
}

CanFrame FramesOut::health(const PoseEstimate& estimate, OperatingMode mode, Timestamp now) {
  const auto& signals = can_layout::kHealth.fields;
  const Matrix3f& covariance = estimate.match_covariance;
  const std::array raw{code(estimate.state),
                       code(estimate.reason),
                       code(mode),
                       std::int64_t{can_tick(now)},
                       to_raw(signals[4], to_seconds_f64(estimate.match_age)),
                       to_raw(signals[5], sigma(covariance(0, 0) + covariance(1, 1))),
                       to_raw(signals[6], sigma(covariance(2, 2)))};
  return next(can_layout::kHealth, estimate.stamp, raw);
}

CanFrame FramesOut::twist(const PoseEstimate& estimate) {
  const auto& signals = can_layout::kTwist.fields;
  const Twist2& twist = estimate.base_twist;
  const std::array raw{to_raw(signals[0], static_cast<double>(twist.x_mps)),
                       to_raw(signals[1], static_cast<double>(twist.y_mps)),
                       to_raw(signals[2], static_cast<double>(twist.omega_radps))};
  return next(can_layout::kTwist, estimate.stamp, raw);
}

CanFrame FramesOut::time(const PoseEstimate& estimate) {
  const std::array raw{std::int64_t{estimate.stamp.time_since_epoch().count()}};
  return next(can_layout::kTime, estimate.stamp, raw);
}

CanFrame FramesOut::sigmas(const CanLayout& layout, Timestamp stamp, const Matrix3f& covariance) {
  const auto& signals = can_layout::kMatchSigma.fields;
  const std::array raw{to_raw(signals[0], sigma(covariance(0, 0))),
                       to_raw(signals[1], sigma(covariance(1, 1))),
                       to_raw(signals[2], sigma(covariance(2, 2)))};
  return next(layout, stamp, raw);
}

CanFrame FramesOut::match_sigma(const PoseEstimate& estimate) {
  return sigmas(can_layout::kMatchSigma, estimate.stamp, estimate.match_covariance);
}

CanFrame FramesOut::drift_sigma(const PoseEstimate& estimate) {
  return sigmas(can_layout::kDriftSigma, estimate.stamp, estimate.drift_covariance);
}

CanFrame FramesOut::correlation(const PoseEstimate& estimate) {
  const auto& signals = can_layout::kCorrelation.fields;
  std::array<std::int64_t, 6> raw{};
  std::size_t i = 0;
  for (const Matrix3f* covariance : {&estimate.match_covariance, &estimate.drift_covariance}) {
    raw[i] = to_raw(signals[i], correlation_of(*covariance, 0, 1));
    raw[i + 1] = to_raw(signals[i + 1], correlation_of(*covariance, 0, 2));
    raw[i + 2] = to_raw(signals[i + 2], correlation_of(*covariance, 1, 2));
    i += 3;
  }
  return next(can_layout::kCorrelation, estimate.stamp, raw);
}

CanFrame FramesOut::event(const Event& event, std::uint32_t index) {
  const std::array raw{std::int64_t{index},
                       code(event.code),
                       code(event.from),
                       code(event.to),
                       code(event.reason),
                       to_raw(can_layout::kEvent.fields[5], static_cast<double>(event.argument))};
  return next(can_layout::kEvent, event.stamp(), raw);
}

CanFrame FramesOut::event_time(const Event& event, std::uint32_t index) {
  const std::array raw{std::int64_t{index}, std::int64_t{event.stamp_us / 1000}};
  return next(can_layout::kEventTime, event.stamp(), raw);
}

CanFrame FramesOut::counter(CounterIndex which, std::uint32_t value) {
  const std::array raw{code(which), std::int64_t{value}};
  return next(can_layout::kCounter, {}, raw);
}

CanFrame FramesOut::calibration(const CalibrationProgress& progress) {
  const auto& signals = can_layout::kCalibration.fields;
  const std::array raw{code(progress.phase),
                       std::int64_t{progress.procedure},
                       to_raw(signals[2], static_cast<double>(progress.percent)),
                       code(progress.refusal.reason),
                       code(progress.refusal.parameter),
                       to_raw(signals[5], static_cast<double>(progress.samples)),
                       to_raw(signals[6], to_seconds_f64(progress.elapsed))};
  return next(can_layout::kCalibration, {}, raw);
}

CanFrame FramesOut::calibration_hint(const CalibrationHint& hint) {
  const std::array raw{
      code(hint.advice),           std::int64_t{hint.wheels},    std::int64_t{hint.track},
      std::int64_t{hint.lidar_xy}, std::int64_t{hint.lidar_yaw}, std::int64_t{hint.time_offset},
      std::int64_t{hint.gyro}};
  return next(can_layout::kCalibrationHint, {}, raw);
}

CanFrame FramesOut::calibration_value(const CalibrationValue& value) {
  const auto& signals = can_layout::kCalibrationValue.fields;
  const std::array raw{code(value.parameter), to_raw(signals[1], value.estimate.value),
                       to_raw(signals[2], value.estimate.std)};
  return next(can_layout::kCalibrationValue, {}, raw);
}

CanFrame FramesOut::reply(const CommandReply& reply) {
  const std::array raw{code(reply.command),          std::int64_t{reply.counter},
                       code(reply.result),           std::int64_t{reply.detail},
                       std::int64_t{reply.accepted}, std::int64_t{reply.refused}};
  return next(can_layout::kReply, {}, raw);
}

}  // namespace picolo::inline v0
