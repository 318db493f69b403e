// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>

#include "doctor/probe.hpp"
#include "picolo/linux/linux_clock.hpp"
#include "picolo/linux/termios_serial_port.hpp"

namespace picolo::tool {
namespace {

namespace fs = std::filesystem;

constexpr Duration kLook = 500ms;
constexpr Duration kPause = 5ms;
std::uint32_t value_of(const devices::Counters& counters, const std::string& name) {
  for (const devices::Counter& counter : counters) {
    if (counter.name == name) { return static_cast<std::uint32_t>(counter.value); }
  }
  return 0;
}

/// The driver itself listens, so that doctor and controller cannot disagree.
template <typename Device, typename Sample, std::size_t kRoom>
void listen(Device& device, LinuxClock& clock, SerialTrial& trial) {
  std::array<Sample, kRoom> samples{};
  const Timestamp end = clock.now() + kLook;
  while (clock.now() < end) {
    static_cast<void>(device.service(clock.now()));
    const auto count = device.poll(4096, samples);
    if (!count) { static_cast<void>(sleep_until(clock.now() + kPause)); }
  }
  const devices::Counters counters = device.counters();
  trial.bytes = value_of(counters, "bytes");
  trial.packets = value_of(counters, "frames");
  trial.bad_checksums = value_of(counters, "bad_checksums");
  for (int i = 0; i < 20 && device.stop() == Status::not_ready; ++i) {
    static_cast<void>(sleep_until(clock.now() + kPause));
  }
}

/// The driver's own, then what lines are commonly set to.
std::vector<std::uint32_t> rates_of(const devices::DeviceInfo& device) {
  std::vector<std::uint32_t> rates = device.bauds;
  for (const std::uint32_t common : {115'200U, 230'400U, 9600U, 57'600U, 460'800U, 921'600U}) {
    if (std::find(rates.begin(), rates.end(), common) == rates.end()) { rates.push_back(common); }
  }
  return rates;
}

using Listen = std::function<void(TermiosSerialPort&, LinuxClock&, SerialTrial&)>;

SerialTrial try_rate(const std::string& path, std::uint32_t baud, const Listen& listen_to,
                     SerialFacts& facts) {
  LinuxClock clock;
  SerialTrial trial{.baud = baud};
  TermiosSerialPort port{clock, {.baud = baud}};
  errno = 0;
  const Status status = port.open(path.c_str());
  const int error = errno;
  if (status == Status::ok) {
    listen_to(port, clock, trial);
    return trial;
  }
  trial.possible = false;
  if (status == Status::io_error) {
    facts.may_open = error != EACCES && error != EPERM;
    facts.is_busy = error == EBUSY;
  }
  return trial;
}

/// Programs that hold the line open, as far as we may look; they would steal bytes.
std::string readers_of(const std::string& path) {
  std::error_code error;
  const fs::path device = fs::canonical(path, error);
  std::string names;
  for (const auto& process : fs::directory_iterator{"/proc", error}) {
    const std::string pid = process.path().filename().string();
    if (pid.find_first_not_of("0123456789") != std::string::npos ||
        pid == std::to_string(::getpid())) {
      continue;
    }
    std::error_code hidden;
    for (const auto& file : fs::directory_iterator{process.path() / "fd", hidden}) {
      if (fs::read_symlink(file.path(), hidden) != device) { continue; }
      std::string name;
      std::getline(std::ifstream{process.path() / "comm"}, name);
      names += (names.empty() ? " (" : ", ") + name + " " + pid;
      break;
    }
  }
  return names.empty() ? names : names + ")";
}

SerialFacts probe(const std::string& path, const std::string& device, std::uint32_t baud,
                  const std::vector<std::uint32_t>& rates, const Listen& listen_to) {
  SerialFacts facts;
  facts.path = path;
  facts.device = device;
  std::error_code error;
  facts.exists = fs::exists(path, error);
  if (!facts.exists) { return facts; }
  facts.is_terminal = fs::is_character_file(path, error);
  if (!facts.is_terminal) { return facts; }
  facts.other_readers = readers_of(path);
  facts.trial = try_rate(path, baud, listen_to, facts);
  const std::string name = fs::canonical(path, error).filename().string();
  int latency_ms = 0;
  if (std::ifstream{"/sys/bus/usb-serial/devices/" + name + "/latency_timer"} >> latency_ms) {
    facts.latency_ms = latency_ms;
  }
  if (!facts.trial.possible || facts.trial.packets > 0) { return facts; }
  for (const std::uint32_t rate : rates) {
    if (rate == baud) { continue; }
    facts.others.push_back(try_rate(path, rate, listen_to, facts));
    if (facts.others.back().packets > facts.others.back().bad_checksums) { break; }
  }
  return facts;
}

}  // namespace

SerialFacts probe_lidar(const std::string& path, const VehicleSettings& settings) {
  const auto* info = devices::find_device(devices::Kind::lidar, settings.lidar_name);
  return probe(path, "lidar", settings.lidar_baud, rates_of(*info),
               [&](TermiosSerialPort& port, LinuxClock& clock, SerialTrial& trial) {
                 const auto device = devices::make_lidar(settings.lidar_name, port, settings.lidar);
                 listen<devices::Lidar, RangeReading, 48>(*device, clock, trial);
               });
}

SerialFacts probe_imu(const std::string& path, const VehicleSettings& settings) {
  const auto* info = devices::find_device(devices::Kind::imu, settings.imu_name);
  return probe(path, "IMU", settings.imu_baud, rates_of(*info),
               [&](TermiosSerialPort& port, LinuxClock& clock, SerialTrial& trial) {
                 const auto device = devices::make_imu(settings.imu_name, port, settings.imu);
                 listen<devices::Imu, ImuSample, 8>(*device, clock, trial);
               });
}

}  // namespace picolo::tool
