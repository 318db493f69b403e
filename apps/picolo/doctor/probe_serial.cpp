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
constexpr Duration kLongLook = 2s;  // a device that answers has to be started first
constexpr Duration kPause = 5ms;

std::uint32_t value_of(const devices::Counters& counters, const char* name) {
  return static_cast<std::uint32_t>(devices::value_of(counters, name));
}

/// The driver itself listens, so that doctor and controller cannot disagree.
template <typename Device, typename Sample, std::size_t kRoom>
void listen(Device& device, bool on_request, LinuxClock& clock, SerialTrial& trial) {
  std::array<Sample, kRoom> samples{};
  const Timestamp start = clock.now();
  for (Timestamp now = start; now < start + kLongLook; now = clock.now()) {
    static_cast<void>(device.service(now));
    const auto count = device.poll(4096, samples);
    if (!count) { static_cast<void>(sleep_until(now + kPause)); }
    trial.seconds = to_seconds_f64(now - start);
    const devices::Counters counters = device.counters();
    trial.bytes = value_of(counters, "bytes");
    trial.packets = value_of(counters, "frames");
    trial.bad_checksums = value_of(counters, "bad_checksums");
    const bool decided = !on_request || trial.bytes == 0 || trial.packets >= kFewPackets;
    if (now >= start + kLook && decided) { break; }
  }
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

struct Line {
  std::string path;
  std::string device;  ///< for people
  const devices::DeviceInfo& info;
  const std::vector<std::uint32_t>& bauds;  ///< that picolo run tries
};

SerialTrial try_rate(const Line& line, std::uint32_t baud, const Listen& listen_to,
                     SerialFacts& facts) {
  LinuxClock clock;
  SerialTrial trial{.baud = baud};
  TermiosSerialPort port{clock, {.baud = baud, .dtr = line.info.dtr}};
  errno = 0;
  const Status status = port.open(line.path.c_str());
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

SerialFacts probe(const Line& line, const Listen& listen_to) {
  SerialFacts facts;
  facts.path = line.path;
  facts.device = line.device;
  facts.bauds = line.bauds;
  std::error_code error;
  facts.exists = fs::exists(line.path, error);
  if (!facts.exists) { return facts; }
  facts.is_terminal = fs::is_character_file(line.path, error);
  if (!facts.is_terminal) { return facts; }
  facts.other_readers = readers_of(line.path);
  const std::uint32_t first = line.bauds.front();
  facts.trial = try_rate(line, first, listen_to, facts);
  const std::string name = fs::canonical(line.path, error).filename().string();
  int latency_ms = 0;
  if (std::ifstream{"/sys/bus/usb-serial/devices/" + name + "/latency_timer"} >> latency_ms) {
    facts.latency_ms = latency_ms;
  }
  if (!facts.trial.possible || facts.trial.packets > 0) { return facts; }
  for (const std::uint32_t rate : rates_of(line.info)) {
    if (rate == first) { continue; }
    facts.others.push_back(try_rate(line, rate, listen_to, facts));
    if (facts.others.back().packets > facts.others.back().bad_checksums) { break; }
  }
  return facts;
}

}  // namespace

SerialFacts probe_lidar(const std::string& path, const VehicleSettings& settings) {
  const auto& info = *devices::find_device(devices::Kind::lidar, settings.lidar_name);
  return probe({path, "lidar", info, settings.lidar_bauds},
               [&](TermiosSerialPort& port, LinuxClock& clock, SerialTrial& trial) {
                 const auto device = devices::make_lidar(settings.lidar_name, port, settings.lidar);
                 listen<devices::Lidar, RangeReading, 48>(*device, info.on_request, clock, trial);
               });
}

SerialFacts probe_imu(const std::string& path, const VehicleSettings& settings) {
  const auto& info = *devices::find_device(devices::Kind::imu, settings.imu_name);
  return probe({path, "IMU", info, settings.imu_bauds},
               [&](TermiosSerialPort& port, LinuxClock& clock, SerialTrial& trial) {
                 const auto device = devices::make_imu(settings.imu_name, port, settings.imu);
                 listen<devices::Imu, ImuSample, 8>(*device, info.on_request, clock, trial);
               });
}

}  // namespace picolo::tool
