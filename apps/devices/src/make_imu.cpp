// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "counters.hpp"
#include "picolo/devices/registry.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"

namespace picolo::inline v0::devices {
namespace {

class WitMotionImu final : public Imu {
 public:
  WitMotionImu(SerialPort& port, const WitMotionConfig& config) : driver_(port, config) {}
  Result<std::size_t> poll(std::size_t max_bytes, std::span<ImuSample> samples) override {
    return driver_.poll(max_bytes, samples);
  }
  Status service(Timestamp /*now*/) override { return Status::ok; }
  Status stop() override { return Status::ok; }
  [[nodiscard]] Counters counters() const override { return to_list(driver_.counters()); }

 private:
  WitMotion driver_;
};

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
  throw std::invalid_argument{"there is no IMU '" + name + "'; use one of " +
                              device_names(Kind::imu)};
}

}  // namespace picolo::inline v0::devices
