// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "counters.hpp"
#include "picolo/devices/registry.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/drivers/rplidar/rplidar.hpp"
#include "picolo/drivers/scip/scip.hpp"
#include "picolo/drivers/ydlidar/ydlidar.hpp"

namespace picolo::inline v0::devices {
namespace {

class Ld06Lidar final : public Lidar {
 public:
  Ld06Lidar(SerialPort& port, const Ld06Config& config) : driver_(port, config) {}
  Result<std::size_t> poll(std::size_t max_bytes, std::span<RangeReading> readings) override {
    return driver_.poll(max_bytes, readings);
  }
  Status service(Timestamp /*now*/) override { return Status::ok; }
  Status stop() override { return Status::ok; }
  [[nodiscard]] Counters counters() const override { return to_list(driver_.counters()); }
  [[nodiscard]] std::string trouble() const override {
    const Ld06Counters c = driver_.counters();
    if (c.bytes == 0) { return "no bytes: check power, wiring and port"; }
    if (c.packets == 0 && c.bytes > 500) { return "bytes, but no packet: check the baud rate"; }
    return {};
  }

 private:
  Ld06 driver_;
};

/// What every protocol can tell from its counters.
template <typename Protocol>
std::string common_trouble(const SerialShell<Protocol>& driver) {
  const SerialCounters c = driver.counters();
  if (c.bytes == 0) { return "no bytes: check power, wiring and port"; }
  if (c.frames == 0 && c.bytes > 2000) {
    return "bytes, but nothing that this device would say: check the baud rate and its name";
  }
  return {};
}

std::string trouble_of(const Rplidar& driver) {
  switch (driver.protocol().trouble()) {
    case RplidarTrouble::none: return {};
    case RplidarTrouble::no_bytes: return "no answer: check power, wiring and port";
    case RplidarTrouble::no_descriptor:
      return "bytes, but no answer among them: wrong baud rate (A1 and A2M8 115200, A2M7, A3 and "
             "S1 256000, C1 460800, S2 and S3 1000000)";
    case RplidarTrouble::unhealthy:
      return "the lidar reports an error: give it 5 V with 1.5 A, then power it off and on";
    case RplidarTrouble::no_nodes:
      return "it answers, but no measurement is whole: check the mode and the cable";
  }
  return {};
}

template <typename Protocol>
std::string trouble_of(const SerialShell<Protocol>& driver) {
  return common_trouble(driver);
}

template <typename Driver>
class SerialLidar final : public Lidar {
 public:
  SerialLidar(SerialPort& port, const typename Driver::Config& config) : driver_(port, config) {}
  Result<std::size_t> poll(std::size_t max_bytes, std::span<RangeReading> readings) override {
    return driver_.poll(max_bytes, readings);
  }
  Status service(Timestamp now) override { return driver_.service(now); }
  Status stop() override { return driver_.stop(); }
  [[nodiscard]] Counters counters() const override { return to_list(driver_.counters()); }
  [[nodiscard]] std::string trouble() const override { return trouble_of(driver_); }

 private:
  Driver driver_;
};

[[noreturn]] void refuse(const std::string& what, const std::string& cure) {
  throw std::invalid_argument{what + "; " + cure};
}

std::unique_ptr<Lidar> make_rplidar(SerialPort& port, const LidarSettings& settings) {
  RplidarConfig config;
  if (settings.mode == "express") {
    config.mode = RplidarMode::express;
    config.samples_per_second = 4000;
  } else if (settings.mode == "ultra") {
    config.mode = RplidarMode::ultra;
    config.express_mode = 3;
    config.samples_per_second = 16'000;
  } else if (settings.mode == "dense") {
    config.mode = RplidarMode::dense;
    config.express_mode = 1;
    config.samples_per_second = 5000;
  } else if (!settings.mode.empty() && settings.mode != "standard") {
    refuse("rplidar has no mode '" + settings.mode + "'", "use standard, express, ultra or dense");
  }
  if (settings.samples_per_second > 0) { config.samples_per_second = settings.samples_per_second; }
  if (settings.motor_pwm > 0) {
    config.motor = RplidarMotor::pwm;
    config.motor_value = settings.motor_pwm;
  }
  if (settings.motor_rpm > 0) {
    config.motor = RplidarMotor::rpm;
    config.motor_value = settings.motor_rpm;
  }
  if (!config.valid()) { refuse("rplidar: a setting is out of its domain", "see picolo --help"); }
  return std::make_unique<SerialLidar<Rplidar>>(port, config);
}

std::unique_ptr<Lidar> make_ydlidar(SerialPort& port, const LidarSettings& settings) {
  YdlidarConfig config;
  if (settings.mode == "tmini") {
    config.optics = YdlidarOptics::aligned;
    config.samples_per_second = 4000;
  } else if (settings.mode == "scl") {
    config.optics = YdlidarOptics::short_base;
    config.samples_per_second = 3000;
  } else if (!settings.mode.empty() && settings.mode != "x4") {
    refuse("ydlidar has no mode '" + settings.mode + "'", "use x4, tmini or scl");
  }
  if (settings.samples_per_second > 0) { config.samples_per_second = settings.samples_per_second; }
  return std::make_unique<SerialLidar<Ydlidar>>(port, config);
}

}  // namespace

std::unique_ptr<Lidar> make_lidar(const std::string& name, SerialPort& port,
                                  const LidarSettings& settings) {
  if (name == "ld06") {
    Ld06Config config;
    if (settings.samples_per_second > 0) {
      config.timeline.points_per_second = settings.samples_per_second;
    }
    return std::make_unique<Ld06Lidar>(port, config);
  }
  if (name == "rplidar") { return make_rplidar(port, settings); }
  if (name == "scip") { return std::make_unique<SerialLidar<Scip>>(port, ScipConfig{}); }
  if (name == "ydlidar") { return make_ydlidar(port, settings); }
  refuse("there is no lidar '" + name + "'", "use one of " + device_names(Kind::lidar));
}

}  // namespace picolo::inline v0::devices
