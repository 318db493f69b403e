// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <vector>

#include "commands.hpp"
#include "live/baud_search.hpp"
#include "live/can_line.hpp"
#include "live/live_loop.hpp"
#include "live/serial_line.hpp"
#include "live/stop_signal.hpp"
#include "picolo/host/files.hpp"
#include "picolo/linux/device_watchdog.hpp"
#include "picolo/linux/file_byte_store.hpp"
#include "picolo/linux/linux_clock.hpp"
#include "picolo/linux/realtime.hpp"
#include "picolo/linux/termios_serial_port.hpp"
#include "processor_time.hpp"

namespace picolo::tool {
namespace {

constexpr Duration kStatusPeriod = 500ms;
constexpr Duration kLookPeriod = 100ms;  // at the rates of the lines
constexpr Duration kStopPatience = 500ms;
constexpr Duration kStopPause = 5ms;

struct Options {
  std::string can;
  std::string lidar;
  std::string imu;
  std::string config;
  std::string record;
  std::string out;
  std::string store;
  std::string watchdog;
  int priority = 0;
  double seconds = 0.0;
  bool json = false;
  bool quiet = false;
};

/// What the kernel shall let pass: the wheels' frames, commands, and who pretends to be us.
std::vector<CanFilter> filters_for(const VehicleSettings& settings, CanBus& bus) {
  std::vector<CanFilter> filters;
  try {
    filters = devices::make_wheels(settings.wheels_name, bus, settings.wheels)->filters();
  } catch (const std::invalid_argument& error) {
    throw host::UserError{ExitCode::usage, "[wheels]", error.what(), "see picolo run --help"};
  }
  const auto own = command_filters(settings.controller.frames_out);
  const std::string overlap = overlap_of(settings, filters);
  if (!overlap.empty()) {
    throw host::UserError{host::ExitCode::usage, "configuration", overlap,
                          "or set another [can] base_id"};
  }
  filters.insert(filters.end(), own.begin(), own.end());
  return filters;
}

/// A serial line whose rate is looked for.
class SearchedLine {
 public:
  SearchedLine(const char* name, TermiosSerialPort& port, const std::vector<std::uint32_t>& bauds)
      : name_(name), port_(port), search_(bauds) {}

  void update(Timestamp now, const devices::Counters& counters) {
    const auto next = search_.update(now, port_.is_open(), counters);
    if (next && !is_ok(port_.set_baud(*next))) {
      fmt::print(stderr, "picolo: {}: the adapter cannot do {} baud\n", name_, *next);
    }
    if (search_.found_another()) {
      fmt::print(stderr, "picolo: {}: speaks at {} baud; [{}] baud = {} saves the search\n", name_,
                 port_.baud(), name_, port_.baud());
    }
  }

 private:
  const char* name_;
  TermiosSerialPort& port_;
  BaudSearch search_;
};

/// The live line on a terminal, a line a second elsewhere.
class StatusLine {
 public:
  explicit StatusLine(bool quiet) : quiet_(quiet), terminal_(::isatty(STDOUT_FILENO) == 1) {}
  ~StatusLine() { clear(); }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void show(double seconds, const LiveVehicle& vehicle) {
    if (quiet_) { return; }
    const PoseEstimate& estimate = vehicle.estimate();
    const LiveFigures figures = vehicle.figures();
    const auto text = fmt::format(
        "{:7.1f} s  {:<12} {:<18} x {:8.3f} m  y {:8.3f} m  yaw {:7.2f} deg  can {}  beams {}  "
        "imu {}  matches {}",
        seconds, to_string(estimate.state), to_string(estimate.reason), estimate.map_T_base.x_m,
        estimate.map_T_base.y_m, estimate.map_T_base.theta_rad * 180.0 / std::numbers::pi,
        figures.controller.can_frames, figures.controller.readings, figures.controller.imu_samples,
        estimate.matches);
    fmt::print("{}{}{}", terminal_ ? "\r\033[K" : "", text, terminal_ ? "" : "\n");
    static_cast<void>(std::fflush(stdout));
    shown_ = terminal_;
  }
  void clear() {
    if (shown_) { fmt::print("\n"); }
    shown_ = false;
  }

 private:
  bool quiet_;
  bool terminal_;
  bool shown_ = false;
};

void run_before_others(int priority) {
  static_cast<void>(use_exact_timers());
  if (priority == 0) { return; }
  if (!is_ok(lock_memory()) || !is_ok(use_fifo_priority(priority))) {
    fmt::print(stderr,
               "picolo: --priority: not allowed; goes on without. Raise the limits rtprio and "
               "memlock in /etc/security/limits.conf, or run as root\n");
  }
}

void tell_change(const StateChange& change) {
  fmt::print(stderr, "picolo: {:.2f} s: {} -> {} ({})\n", change.since_start_s,
             to_string(change.from), to_string(change.to), to_string(change.reason));
}

double process_cpu_s() {
  timespec time{};
  static_cast<void>(clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time));
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

host::Json to_json(const devices::Counters& counters) {
  host::Json json = host::Json::object();
  for (const devices::Counter& counter : counters) { json[counter.name] = counter.value; }
  return json;
}

void report(const Options& options, const LiveVehicle& vehicle, const DriveJournal& journal,
            double seconds, double cpu_s) {
  const LiveFigures figures = vehicle.figures();
  const double share = seconds > 0.0 ? cpu_s / seconds : 0.0;
  if (!options.json) {
    fmt::print("{:.1f} s, {} cycles ({} slipped), {:.2f} % of a processor, {} at the end\n",
               seconds, journal.cycles(), figures.slipped, 100.0 * share,
               to_string(vehicle.estimate().state));
    return;
  }
  host::Json json;
  json["seconds"] = seconds;
  json["cycles"] = journal.cycles();
  json["slipped"] = figures.slipped;
  json["processor_share"] = share;
  json["state"] = to_string(vehicle.estimate().state);
  json["reason"] = to_string(vehicle.estimate().reason);
  json["changes"] = journal.changes_json();
  json["pose_hash"] = journal.hash();
  json["can_frames"] = figures.controller.can_frames;
  json["foreign_frames"] = figures.controller.foreign_frames;
  json["ticks"] = figures.controller.ticks;
  json["readings"] = figures.controller.readings;
  json["imu_samples"] = figures.controller.imu_samples;
  json["frames_sent"] = figures.frames_sent;
  json["frames_refused"] = figures.frames_refused;
  json["commands_accepted"] = figures.commands.accepted;
  json["matched"] = figures.localiser.matched;
  json["lidar"] = to_json(vehicle.lidar_counters());
  json["imu"] = to_json(vehicle.imu_counters());
  fmt::print("{}\n", host::to_text(json));
}

ExitCode run(const Options& options) {
  const VehicleSettings settings = read_vehicle(options.config);
  if (options.imu.empty() && settings.controller.health.expects_gyro) {
    throw host::UserError{ExitCode::usage, "--imu", "is missing",
                          "give its serial line, or say [imu] present = false in --config"};
  }
  const StopSignal stop;
  LinuxClock linux_clock;
  LatchedClock clock;
  LinuxCycleCounter cycles;
  CanLine can{linux_clock, options.can, CanLine::Role::second};
  if (!can.open(filters_for(settings, can))) {
    fmt::print(stderr, "picolo: {}: is not there yet; waiting for it\n", options.can);
  }
  const devices::DeviceInfo* kind = devices::find_device(devices::Kind::lidar, settings.lidar_name);
  TermiosSerialPort lidar{
      linux_clock, {.baud = settings.lidar_bauds.front(), .dtr = kind == nullptr || kind->dtr}};
  TermiosSerialPort imu{linux_clock, {.baud = settings.imu_bauds.front()}};
  static_cast<void>(open_line(lidar, options.lidar, "lidar"));
  if (!options.imu.empty()) { static_cast<void>(open_line(imu, options.imu, "imu")); }
  FileByteStore store{{.geometry = kMapStoreGeometry}};
  if (!options.store.empty() && !is_ok(store.open(options.store.c_str()))) {
    throw host::UserError{ExitCode::device, options.store, "is no store of picolo, or in use",
                          "give a file that does not exist yet"};
  }
  NoWatchdog no_watchdog;
  DeviceWatchdog device_watchdog;
  if (!options.watchdog.empty() && !is_ok(device_watchdog.open(options.watchdog.c_str()))) {
    throw host::UserError{ExitCode::device, options.watchdog, "cannot be opened",
                          "modprobe softdog, or run as root"};
  }
  Watchdog& watchdog = options.watchdog.empty() ? static_cast<Watchdog&>(no_watchdog)
                                                : static_cast<Watchdog&>(device_watchdog);
  std::optional<Recorder> recorder;
  if (!options.record.empty()) {
    recorder.emplace(options.record, options.config.empty() ? "" : host::read_file(options.config),
                     can, lidar, imu);
  }
  if (recorder && !options.store.empty()) {
    std::filesystem::copy_file(options.store, RecordFolder{options.record}.store(),
                               std::filesystem::copy_options::overwrite_existing);
  }
  CanBus& bus = recorder ? recorder->can() : can;
  SerialPort& lidar_port = recorder ? recorder->lidar() : lidar;
  SerialPort& imu_port = recorder ? recorder->imu() : imu;
  const auto vehicle = make_vehicle(settings, {.board = {bus, clock, cycles, watchdog},
                                               .lidar = lidar_port,
                                               .imu = imu_port,
                                               .store = options.store.empty() ? nullptr : &store});
  LiveLoop loop{*vehicle, clock, recorder ? &*recorder : nullptr};
  StatusLine status{options.quiet || options.json};
  run_before_others(options.priority);
  const Timestamp start = linux_clock.now();
  const double cpu_before_s = process_cpu_s();
  loop.start(start);
  SearchedLine lidar_rate{"lidar", lidar, settings.lidar_bauds};
  SearchedLine imu_rate{"imu", imu, settings.imu_bauds};
  Timestamp next_look = start;
  Timestamp next_status = start;
  const auto end = options.seconds > 0.0 ? start + from_seconds(options.seconds) : Timestamp::max();
  Timestamp now = start;
  while (!stop.came() && now < end) {
    static_cast<void>(sleep_until(vehicle->next_frame()));
    now = linux_clock.now();
    if (now < vehicle->next_frame()) { continue; }  // a signal
    if (loop.cycle(now)) {
      status.clear();
      tell_change(loop.journal().changes().back());
    }
    if (now >= next_look) {
      next_look = now + kLookPeriod;
      lidar_rate.update(now, vehicle->lidar_counters());
      imu_rate.update(now, vehicle->imu_counters());
    }
    if (now < next_status) { continue; }
    next_status = now + kStatusPeriod;
    status.show(to_seconds_f64(now - start), *vehicle);
  }
  status.clear();
  const Timestamp last_try = linux_clock.now() + kStopPatience;
  while (vehicle->stop() == Status::not_ready && linux_clock.now() < last_try) {
    static_cast<void>(sleep_until(linux_clock.now() + kStopPause));
  }
  loop.finish();
  device_watchdog.disarm();
  const std::string trouble = vehicle->trouble();
  if (!trouble.empty()) { fmt::print(stderr, "picolo: {}\n", trouble); }
  if (!options.out.empty()) {
    host::make_folder(options.out);
    const std::filesystem::path folder{options.out};
    write_tum(folder / "trajectory.tum", loop.journal().trajectory());
    write_tum(folder / "odometry.tum", loop.journal().odometry());
    write_map(folder, "map", vehicle->map());
  }
  report(options, *vehicle, loop.journal(), to_seconds_f64(now - start),
         process_cpu_s() - cpu_before_s);
  return ExitCode::done;
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("run", "The controller live on a CAN bus and serial lines");
  command
      ->add_option("--can", options->can,
                   "CAN interface, slcan:TTY of a USB adapter, or socket:PATH of a simulation")
      ->required()
      ->type_name("IF");
  command->add_option("--lidar", options->lidar, "Serial line of the lidar")
      ->required()
      ->type_name("TTY");
  command->add_option("--imu", options->imu, "Serial line of the IMU")->type_name("TTY");
  command->add_option("--config", options->config, "TOML file that describes the vehicle")
      ->type_name("FILE");
  command->add_option("--record", options->record, "Write everything that arrives to this folder")
      ->type_name("DIR");
  command->add_option("--out", options->out, "Write trajectory and map there at the end")
      ->type_name("DIR");
  command
      ->add_option("--store", options->store, "File for maps and calibrations, which commands save")
      ->type_name("FILE");
  command->add_option("--watchdog", options->watchdog, "Device that resets a machine that hangs")
      ->type_name("DEVICE");
  command->add_option("--seconds", options->seconds, "Stop after this time; 0: run on")
      ->type_name("S");
  command->add_option("--priority", options->priority, "Real-time priority, memory locked; 0: none")
      ->check(CLI::Range(0, 99))
      ->type_name("1..99");
  command->add_flag("--json", options->json, "Print one JSON object at the end, nothing before");
  command->add_flag("--quiet", options->quiet, "No status line");
  command->footer(
      "Publishes pose, health and more on the bus (picolo protocol), takes commands from it.\n"
      "Changes of state go to standard error. Devices may come later, go and come back. Ctrl-C or\n"
      "kill end it in good order.\n"
      "\n"
      "Examples:\n"
      "  picolo run --can can0 --lidar /dev/ttyUSB0 --imu /dev/ttyUSB1 --config vehicle.toml\n"
      "  picolo run --can can0 --lidar /dev/ttyUSB0 --imu /dev/ttyUSB1 --record /tmp/drive\n"
      "      picolo replay /tmp/drive gives the same poses bit for bit\n"
      "  picolo run --can slcan:/dev/ttyACM0 --lidar /dev/ttyUSB0 --imu /dev/ttyUSB1\n"
      "      an adapter that speaks SLCAN, without slcand; slcan:TTY,BITRATE,BAUD for other than\n"
      "      500000 bit/s on the bus and 2000000 baud on the line\n"
      "  picolo simulate --can socket:/tmp/bus --lidar-pty /tmp/lidar --imu-pty /tmp/imu &\n"
      "  picolo run --can socket:/tmp/bus --lidar /tmp/lidar --imu /tmp/imu\n"
      "      without any hardware\n"
      "\n"
      "Settings: [vehicle] profile left_radius_m right_radius_m track_m counts_per_revolution\n"
      "max_wheel_speed_mps; [wheels] driver left_id right_id left_inverted right_inverted\n"
      "produce_sync set_up_nodes pole_pairs counts_per_turn dbc_file left_signal right_signal\n"
      "speed_ticks_per_unit; [lidar] driver baud x_m y_m yaw_rad min_range_m max_range_m mode\n"
      "samples_per_second motor_pwm motor_rpm; [imu] driver baud present gyro_sign\n"
      "rate_full_scale_degps acceleration_full_scale_g; [can] base_id frames_out; [cycle]\n"
      "minor_frame_ms major_frame_ms tolerated_overruns search_slices; [localiser] as for\n"
      "replay. Without a baud every rate of the driver is tried. Without a file: the nominal\n"
      "sizes of the simulated vehicle.\n");
  command->callback([&action, options] { action = [options] { return run(*options); }; });
}

}  // namespace picolo::tool
