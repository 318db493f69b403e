// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "counters.hpp"
#include "picolo/devices/registry.hpp"
#include "picolo/drivers/bno08x/bno08x_rvc.hpp"
#include "picolo/drivers/common/axis_watch.hpp"
#include "picolo/drivers/vectornav/vectornav.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"
#include "picolo/drivers/xsens/xsens.hpp"

namespace picolo::inline v0::devices {
namespace {

/// Looks at every sample on its way.
class WatchedImu : public Imu {
 public:
  [[nodiscard]] std::string trouble() const override {
    if (watch_.gyro_stuck()) {
      return "the gyro repeats itself while the accelerometer moves: power the sensor off and on, "
             "then check its settings";
    }
    if (watch_.accelerometer_stuck()) {
      return "the accelerometer repeats itself: power the sensor off and on";
    }
    return {};
  }

 protected:
  Result<std::size_t> watch(const Result<std::size_t>& count, std::span<const ImuSample> samples) {
    for (std::size_t i = 0; i < count.value_or(0); ++i) { watch_.update(samples[i]); }
    return count;
  }

 private:
  AxisWatch watch_{};
};

class WitMotionImu final : public WatchedImu {
 public:
  WitMotionImu(SerialPort& port, const WitMotionConfig& config) : driver_(port, config) {}
  Result<std::size_t> poll(std::size_t max_bytes, std::span<ImuSample> samples) override {
    return watch(driver_.poll(max_bytes, samples), samples);
  }
  Status service(Timestamp /*now*/) override { return Status::ok; }
  Status stop() override { return Status::ok; }
  [[nodiscard]] Counters counters() const override { return to_list(driver_.counters()); }

 private:
  WitMotion driver_;
};

template <typename Driver>
class SerialImu final : public WatchedImu {
 public:
  SerialImu(SerialPort& port, const typename Driver::Config& config) : driver_(port, config) {}
  Result<std::size_t> poll(std::size_t max_bytes, std::span<ImuSample> samples) override {
    return watch(driver_.poll(max_bytes, samples), samples);
  }
  Status service(Timestamp now) override { return driver_.service(now); }
  Status stop() override { return driver_.stop(); }
  [[nodiscard]] Counters counters() const override { return to_list(driver_.counters()); }

 private:
  Driver driver_;
};

constexpr float kRadPerDeg = 0.01745329252F;
constexpr float kStandardGravity_mps2 = 9.80665F;

/// Full scales of the sensors that deliver SI units.
template <typename Config>
Config with_full_scales(const ImuSettings& settings) {
  Config config;
  if (settings.rate_full_scale_degps > 0) {
    config.rate_full_scale_radps = static_cast<float>(settings.rate_full_scale_degps) * kRadPerDeg;
  }
  if (settings.acceleration_full_scale_g > 0) {
    config.acceleration_full_scale_mps2 =
        static_cast<float>(settings.acceleration_full_scale_g) * kStandardGravity_mps2;
  }
  return config;
}

std::unique_ptr<Imu> make_witmotion(SerialPort& port, const ImuSettings& settings) {
  WitMotionConfig config;
  if (settings.rate_full_scale_degps > 0) {
    config.group.rate_full_scale_degps = static_cast<std::uint16_t>(settings.rate_full_scale_degps);
  }
  if (settings.acceleration_full_scale_g > 0) {
    config.group.acceleration_full_scale_g =
        static_cast<std::uint16_t>(settings.acceleration_full_scale_g);
  }
  return std::make_unique<WitMotionImu>(port, config);
}

}  // namespace

std::unique_ptr<Imu> make_imu(const std::string& name, SerialPort& port,
                              const ImuSettings& settings) {
  if (name == "witmotion") { return make_witmotion(port, settings); }
  if (name == "bno08x-rvc") {
    return std::make_unique<SerialImu<Bno08xRvc>>(port, Bno08xRvcConfig{});
  }
  if (name == "xsens") {
    return std::make_unique<SerialImu<Xsens>>(port, with_full_scales<XsensConfig>(settings));
  }
  if (name == "vectornav") {
    return std::make_unique<SerialImu<Vectornav>>(port,
                                                  with_full_scales<VectornavConfig>(settings));
  }
  throw std::invalid_argument{"there is no IMU '" + name + "'; use one of " +
                              device_names(Kind::imu)};
}

}  // namespace picolo::inline v0::devices
