// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Xsens MTi on a serial line (115200 baud), in measurement mode with MTData2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/drivers/common/serial_shell.hpp"
#include "picolo/drivers/xsens/xsens_message.hpp"
#include "picolo/sensing/device_clock.hpp"
#include "picolo/sensing/imu_sample.hpp"

namespace picolo::inline v0 {

struct XsensConfig {
  float rate_full_scale_radps = 34.9F;         ///< 2000 deg/s
  float acceleration_full_scale_mps2 = 98.0F;  ///< 10 g
  bool use_device_clock = true;
  DeviceClockConfig clock{.wrap = Duration{(std::int64_t{1} << 32) * 100}, .resolution = 100us};
  bool active = true;  ///< puts the device into measurement mode when it is silent
  Duration silence_timeout = 1000ms;
  [[nodiscard]] constexpr bool valid() const {
    return rate_full_scale_radps > 0.0F && acceleration_full_scale_mps2 > 0.0F && clock.valid() &&
           silence_timeout > Duration{0};
  }
};

/// Pure, see SerialProtocol. A message with a rate is a sample; an acceleration that comes less
/// often is repeated. Stamps are those of SampleTimeFine, mapped, where the device sends it.
class XsensProtocol {
 public:
  using Sample = ImuSample;
  using Config = XsensConfig;
  static constexpr std::size_t kMaxSamplesPerByte = 16;
  static constexpr std::size_t kMaxRequest = 8;

  explicit XsensProtocol(const XsensConfig& config = {}) : config_(config), clock_(config.clock) {}

  std::size_t push(std::uint8_t byte, const ByteTime& time, std::span<ImuSample> samples);
  std::size_t request(Timestamp now, std::span<std::uint8_t> out);
  std::size_t farewell(std::span<std::uint8_t> out);
  void interrupted();
  /// True when the last `push` completed a data message, `data()`.
  [[nodiscard]] bool data_ready() const { return data_ready_; }
  [[nodiscard]] const XsensData& data() const { return data_; }
  [[nodiscard]] SerialCounters counters() const;

 private:
  void note_counter();
  bool to_sample(Timestamp sent, StampSource source, ImuSample& sample);

  XsensConfig config_;
  DeviceClock clock_;
  Framer<XsensFormat> framer_{};
  XsensData data_{};
  bool data_ready_ = false;
  std::array<float, 3> acceleration_mps2_{};
  std::uint16_t last_counter_ = 0;
  bool has_counter_ = false;
  Timestamp last_stamp_ = Timestamp::min();
  Timestamp deadline_ = Timestamp::min();
  bool asked_ = false;
  bool resting_ = false;
  SerialCounters counters_{};
};

using Xsens = SerialShell<XsensProtocol>;

}  // namespace picolo::inline v0
