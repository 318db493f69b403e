// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// VectorNav VN-100, VN-200, VN-300 on a serial line, text or binary, as they are configured.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/drivers/common/serial_shell.hpp"
#include "picolo/drivers/vectornav/vectornav_message.hpp"
#include "picolo/sensing/device_clock.hpp"
#include "picolo/sensing/imu_sample.hpp"

namespace picolo::inline v0 {

struct VectornavConfig {
  float rate_full_scale_radps = 34.9F;          ///< 2000 deg/s
  float acceleration_full_scale_mps2 = 156.0F;  ///< 16 g
  bool use_device_clock = true;
  DeviceClockConfig clock{.wrap = Duration{std::int64_t{1} << 50}, .resolution = 100us};
  [[nodiscard]] constexpr bool valid() const {
    return rate_full_scale_radps > 0.0F && acceleration_full_scale_mps2 > 0.0F && clock.valid();
  }
};

/// Pure, see SerialProtocol. A message with rates and accelerations is a sample. Binary messages
/// with TimeStartup carry the device's time; text does not.
class VectornavProtocol {
 public:
  using Sample = ImuSample;
  using Config = VectornavConfig;
  static constexpr std::size_t kMaxSamplesPerByte = 16;

  explicit VectornavProtocol(const VectornavConfig& config = {})
      : config_(config), clock_(config.clock) {}

  std::size_t push(std::uint8_t byte, const ByteTime& time, std::span<ImuSample> samples);
  void interrupted() { framer_.reset(); }
  /// True when the last `push` completed a message, `data()`.
  [[nodiscard]] bool data_ready() const { return data_ready_; }
  [[nodiscard]] const VectornavData& data() const { return data_; }
  [[nodiscard]] SerialCounters counters() const;

 private:
  bool to_sample(Timestamp sent, StampSource source, ImuSample& sample);

  VectornavConfig config_;
  DeviceClock clock_;
  Framer<VectornavFormat> framer_{};
  VectornavData data_{};
  bool data_ready_ = false;
  Timestamp last_stamp_ = Timestamp::min();
  SerialCounters counters_{};
};

using Vectornav = SerialShell<VectornavProtocol>;

}  // namespace picolo::inline v0
