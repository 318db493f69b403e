// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "commands.hpp"
#include "live/can_line.hpp"
#include "live/pty_line.hpp"
#include "live/stop_signal.hpp"
#include "live/traffic_log.hpp"
#include "live/vehicle_settings.hpp"
#include "picolo/devices/dialects.hpp"
#include "picolo/host/trajectory.hpp"
#include "picolo/linux/linux_clock.hpp"
#include "picolo/sim/simulation.hpp"

namespace picolo::tool {
namespace {

constexpr Duration kStep = 1ms;
constexpr Duration kTruthPeriod = 20ms;

struct Options {
  std::string can;
  std::string lidar_pty;
  std::string imu_pty;
  std::string scene = "office";
  std::string config;
  std::string truth;
  std::string record;
  std::uint32_t lidar_baud = 0;
  std::uint32_t imu_baud = 0;
  std::vector<std::string> unplug;
  int seed = 1;
  double seconds = 0.0;
  double stand = 1.0;
  bool wait = false;
};

/// A device that is pulled out for a while.
struct Absence {
  std::string device;
  Duration from{};
  Duration to{};
};

Absence parse_absence(const std::string& text) {
  const std::size_t first = text.find(':');
  const std::size_t second = text.find(':', first == std::string::npos ? first : first + 1);
  double from_s = 0.0;
  double length_s = 0.0;
  const auto number = [](std::string_view word, double& value) {
    const auto parsed = std::from_chars(word.data(), word.data() + word.size(), value);
    return parsed.ec == std::errc{} && parsed.ptr == word.data() + word.size() && value >= 0.0;
  };
  const std::string device = text.substr(0, first);
  if (second == std::string::npos || (device != "lidar" && device != "imu" && device != "can") ||
      !number(std::string_view{text}.substr(first + 1, second - first - 1), from_s) ||
      !number(std::string_view{text}.substr(second + 1), length_s)) {
    throw host::UserError{ExitCode::usage, "--unplug " + text, "is no DEVICE:FROM:SECONDS",
                          "for example lidar:10:3 pulls the lidar out for 3 s, 10 s after start; "
                          "also imu and can"};
  }
  return {device, from_seconds(from_s), from_seconds(from_s + length_s)};
}

sim::SceneName scene_of(const std::string& name) {
  if (name == "office") { return sim::SceneName::office; }
  if (name == "room") { return sim::SceneName::room; }
  if (name == "hall") { return sim::SceneName::hall; }
  return sim::SceneName::corridor;
}

/// Between the simulated wires, in the words of the devices that the configuration names, and those
/// of this machine.
class Bridge {
 public:
  Bridge(const Options& options, const VehicleSettings& settings, std::optional<CanLine>& can,
         Clock& clock, sim::Simulation& simulation)
      : can_(can),
        can_name_(options.can),
        clock_(clock),
        wheels_(devices::make_wheel_dialect(settings.wheels_name, simulation.can(),
                                            simulation.clock(), wheel_dialect(settings))),
        lidar_port_(devices::make_lidar_dialect(settings.lidar_name, simulation.lidar_port(),
                                                settings.lidar.mode)),
        imu_port_(devices::make_imu_dialect(settings.imu_name, simulation.imu_port())) {
    if (!options.lidar_pty.empty()) {
      lidar_.emplace(options.lidar_pty).set_baud(options.lidar_baud);
    }
    if (!options.imu_pty.empty()) { imu_.emplace(options.imu_pty).set_baud(options.imu_baud); }
    if (!options.record.empty()) { log_.emplace(options.record); }
  }

  /// What the controller has sent since the last step.
  void listen(Timestamp now) {
    if (can_) {
      for (Result<CanFrame> frame = can_->receive(); frame; frame = can_->receive()) {
        if (log_) { log_->can(*frame); }
        static_cast<void>(wheels_->transmit(*frame));
      }
    }
    take(lidar_, *lidar_port_);
    take(imu_, *imu_port_);
    now_ = now;
  }
  void speak() {
    for (auto frame = wheels_->receive(); frame; frame = wheels_->receive()) {
      if (can_ && is_ok(can_->transmit(*frame)) && log_) { log_->can(*frame); }
    }
    send(*lidar_port_, lidar_, "lidar");
    send(*imu_port_, imu_, "imu");
  }
  void plug(const std::string& device, bool in) {
    std::optional<PtyLine>& line = device == "lidar" ? lidar_ : imu_;
    if (device == "can" ? can_.has_value() == in : !line || line->plugged() == in) { return; }
    fmt::print(stderr, "picolo: {} {}\n", device, in ? "plugged in" : "unplugged");
    if (device != "can") {
      in ? line->plug() : line->unplug();
    } else if (in) {
      static_cast<void>(can_.emplace(clock_, can_name_, CanLine::Role::first).open());
    } else {
      can_.reset();
    }
  }

 private:
  static devices::WheelDialect wheel_dialect(const VehicleSettings& settings) {
    return {.left_id = settings.wheels.left_id,
            .right_id = settings.wheels.right_id,
            .pole_pairs = settings.wheels.pole_pairs};
  }
  static void take(std::optional<PtyLine>& line, SerialPort& port) {
    if (!line) { return; }
    const std::vector<std::uint8_t> bytes = line->take();
    if (!bytes.empty()) { static_cast<void>(port.write(bytes)); }
  }
  void send(SerialPort& port, std::optional<PtyLine>& line, const char* name) {
    std::array<std::uint8_t, 512> bytes{};
    for (auto read = port.read(bytes); read; read = port.read(bytes)) {
      const auto chunk = std::span<const std::uint8_t>{bytes}.first((*read).size);
      if (line) { line->send(chunk); }
      if (log_ && line && line->plugged()) { log_->serial(name, chunk, now_); }
    }
  }

  std::optional<CanLine>& can_;  ///< none: the vehicle has left the bus
  std::string can_name_;
  Clock& clock_;
  devices::CanBusPointer wheels_;
  devices::SerialPortPointer lidar_port_;
  devices::SerialPortPointer imu_port_;
  std::optional<PtyLine> lidar_;
  std::optional<PtyLine> imu_;
  std::optional<TrafficLog> log_;
  Timestamp now_{};
};

std::unique_ptr<Bridge> make_bridge(const Options& options, const VehicleSettings& settings,
                                    std::optional<CanLine>& can, Clock& clock,
                                    sim::Simulation& simulation) {
  try {
    return std::make_unique<Bridge>(options, settings, can, clock, simulation);
  } catch (const std::invalid_argument& error) {
    throw host::UserError{host::ExitCode::usage, options.config, error.what(),
                          "name other drivers in the configuration"};
  }
}

/// Sleeps until the controller's first frame.
void wait_for_controller(CanLine& can, LinuxClock& clock, const StopSignal& stop) {
  while (!stop.came() && !can.receive()) {
    static_cast<void>(sleep_until(clock.now() + Duration{10'000}));
  }
}

ExitCode simulate(const Options& options) {
  std::vector<Absence> absences;
  for (const std::string& text : options.unplug) { absences.push_back(parse_absence(text)); }
  const VehicleSettings settings = read_vehicle(options.config);
  const StopSignal stop;
  LinuxClock clock;
  std::optional<CanLine> can;
  static_cast<void>(can.emplace(clock, options.can, CanLine::Role::first).open());
  sim::SimulationConfig config{.seed = static_cast<std::uint64_t>(options.seed)};
  config.scene = sim::make_scene(scene_of(options.scene));
  config.lidar.counter_clockwise = devices::turns_counter_clockwise(settings.lidar_name);
  config.drive.stand_at_start = from_seconds(options.stand);
  if (options.wait) { wait_for_controller(*can, clock, stop); }
  const Timestamp start = clock.now();
  config.start = start;
  const auto simulation = std::make_unique<sim::Simulation>(config);
  const auto bridge = make_bridge(options, settings, can, clock, *simulation);
  host::Trajectory truth;
  Timestamp next_truth = start;
  const auto end = options.seconds > 0.0 ? start + from_seconds(options.seconds) : Timestamp::max();
  Timestamp next = start;
  for (Timestamp now = start; !stop.came() && now < end; now = clock.now()) {
    for (const char* device : {"lidar", "imu", "can"}) {
      const Duration elapsed = now - start;
      bridge->plug(device, std::none_of(absences.begin(), absences.end(), [&](auto& absence) {
                     return absence.device == device && elapsed >= absence.from &&
                            elapsed < absence.to;
                   }));
    }
    bridge->listen(now);
    simulation->advance_to(now);
    bridge->speak();
    if (now >= next_truth) {
      next_truth = now + kTruthPeriod;
      truth.push_back({to_seconds_f64(now.time_since_epoch()),
                       between(config.scene.world_T_start, simulation->truth().world_T_base)});
    }
    next = std::max(next + kStep, now);
    static_cast<void>(sleep_until(next));
  }
  if (!options.truth.empty()) { write_tum(options.truth, truth); }
  return ExitCode::done;
}

}  // namespace

void add_simulate(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("simulate", "The simulated vehicle in real time, on this machine's wires");
  command->add_option("--can", options->can, "CAN interface (vcan0), or socket:PATH")
      ->required()
      ->type_name("IF");
  command->add_option("--lidar-pty", options->lidar_pty, "Make the lidar's serial line here")
      ->type_name("PATH");
  command->add_option("--imu-pty", options->imu_pty, "Make the IMU's serial line here")
      ->type_name("PATH");
  command->add_option("--config", options->config, "TOML file of picolo run: which devices it has")
      ->type_name("FILE");
  command
      ->add_option("--lidar-baud", options->lidar_baud,
                   "The lidar speaks at this rate; a line opened at another is garbled")
      ->type_name("BAUD");
  command->add_option("--imu-baud", options->imu_baud, "The same for the IMU")->type_name("BAUD");
  command->add_option("--scene", options->scene, "Where it drives")
      ->check(CLI::IsMember({"office", "room", "hall", "corridor"}))
      ->capture_default_str();
  command->add_option("--seed", options->seed, "Noise, slip and biases")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--seconds", options->seconds, "Stop after this time; 0: run on")
      ->type_name("S");
  command->add_option("--stand", options->stand, "Stand still for so long at the start")
      ->capture_default_str()
      ->check(CLI::Range(0.0, 600.0))
      ->type_name("S");
  command->add_flag("--wait", options->wait, "Begin with the controller's first frame");
  command->add_option("--unplug", options->unplug, "Pull lidar, imu or can out for a while")
      ->type_name("DEVICE:FROM:SECONDS");
  command->add_option("--truth", options->truth, "Write the true poses at the end (TUM)")
      ->type_name("FILE");
  command->add_option("--record", options->record, "Write a candump log and the serial bytes there")
      ->type_name("DIR");
  command->footer(
      "Without --config the lidar is an LD06 (230400 baud), the IMU a WitMotion (115200), the "
      "wheels\n"
      "two CiA 402 drives, nodes 1 and 2. It can have every other driver of picolo run too "
      "(rplidar in\n"
      "any mode; ydlidar as a T-mini): give both the same file. Encoders count 4096 a\n"
      "turn; vesc: 6 * pole_pairs; dbc: the two words of 0x205 that wrap at 16384 (comma body).\n"
      "True poses are in the controller's map frame, if that started while the vehicle stood; "
      "stamps\n"
      "are those of the monotonic clock that both processes share.\n"
      "\n"
      "Examples:\n"
      "  picolo simulate --can vcan0 --lidar-pty /tmp/lidar --imu-pty /tmp/imu --wait\n"
      "  picolo run --can vcan0 --lidar /tmp/lidar --imu /tmp/imu\n"
      "      in another terminal; sudo ip link add vcan0 type vcan && sudo ip link set vcan0 up\n"
      "  picolo simulate --can socket:/tmp/bus --lidar-pty /tmp/lidar --imu-pty /tmp/imu\n"
      "      for a kernel without CAN; the same --can for picolo run\n"
      "  picolo simulate ... --unplug lidar:10:3 --truth truth.tum --seconds 30\n"
      "  picolo simulate ... --config vehicle.toml --lidar-baud 256000\n"
      "      its rplidar is found by picolo run --config vehicle.toml, whatever its rate\n");
  command->callback([&action, options] { action = [options] { return simulate(*options); }; });
}

}  // namespace picolo::tool
