// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/folder_replay.hpp"

#include <fmt/format.h>

#include <fstream>
#include <sstream>

#include "live/arrival_ports.hpp"
#include "live/live_loop.hpp"
#include "live/replay_ports.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"
#include "picolo/linux/file_byte_store.hpp"
#include "processor_time.hpp"

namespace picolo::tool {
namespace {

namespace fs = std::filesystem;
using host::ExitCode;
using host::UserError;

VehicleSettings settings_of(const RecordFolder& folder, const std::string& config) {
  if (!config.empty()) { return read_vehicle(config); }
  return read_vehicle(fs::exists(folder.config()) ? folder.config().string() : "");
}

void keep(FolderReplay& replay, const LiveVehicle& vehicle, const DriveJournal& journal) {
  replay.journal = journal;
  replay.drive.trajectory = journal.trajectory();
  replay.drive.odometry = journal.odometry();
  replay.drive.counters = vehicle.figures().localiser;
  replay.drive.map = vehicle.map();
}

/// The lines of cycles.log.
class CycleList {
 public:
  explicit CycleList(const fs::path& path) : path_(path), file_(path) {
    std::string line;
    std::string word;
    std::int64_t start_us = 0;
    std::getline(file_, line);
    if (line.rfind("# picolo cycles 1", 0) != 0) {
      throw UserError{ExitCode::input, path.string(), "is of another version",
                      "replay it with the picolo that recorded it"};
    }
    if (!(file_ >> word >> start_us) || word != "start") { damaged(); }
    start_ = Timestamp{Duration{start_us}};
  }
  [[nodiscard]] Timestamp start() const { return start_; }
  struct Cycle {
    Timestamp time{};
    std::string can, lidar, imu;
  };
  /// False at the end, also when the last line is torn.
  bool next(Cycle& cycle) {
    std::int64_t time_us = 0;
    if (!(file_ >> time_us >> cycle.can >> cycle.lidar >> cycle.imu)) { return false; }
    cycle.time = Timestamp{Duration{time_us}};
    return true;
  }

 private:
  [[noreturn]] void damaged() const {
    throw UserError{ExitCode::input, path_.string(), "is damaged",
                    "get a whole copy of the recording"};
  }
  fs::path path_;
  std::ifstream file_;
  Timestamp start_{};
};

/// The store as it was when the recording began, in a copy that may be written to.
class StoreCopy {
 public:
  explicit StoreCopy(const RecordFolder& folder)
      : store_{{.geometry = kMapStoreGeometry, .durable = false}} {
    if (!fs::exists(folder.store())) { return; }
    path_ = folder.path / "store.replayed";
    fs::copy_file(folder.store(), path_, fs::copy_options::overwrite_existing);
    present_ = is_ok(store_.open(path_.c_str()));
  }
  ~StoreCopy() {
    std::error_code ignored;
    if (!path_.empty()) { fs::remove(path_, ignored); }
  }
  StoreCopy(const StoreCopy&) = delete;
  StoreCopy& operator=(const StoreCopy&) = delete;
  [[nodiscard]] ByteStore* get() { return present_ ? &store_ : nullptr; }

 private:
  fs::path path_;
  FileByteStore store_;
  bool present_ = false;
};

void replay_cycles(const RecordFolder& folder, const VehicleSettings& settings,
                   FolderReplay& replay) {
  CycleList cycles{folder.cycles()};
  LatchedClock clock;
  ProcessorTimeCounter counter;
  NoWatchdog watchdog;
  ReplayCanBus can{folder.can()};
  ReplaySerialPort lidar{folder, "lidar", settings.lidar_bauds.front()};
  ReplaySerialPort imu{folder, "imu", settings.imu_bauds.front()};
  StoreCopy store{folder};
  const auto vehicle = make_vehicle(
      settings,
      {.board = {can, clock, counter, watchdog}, .lidar = lidar, .imu = imu, .store = store.get()});
  LiveLoop loop{*vehicle, clock, nullptr};
  loop.start(cycles.start());
  std::size_t left_over = 0;
  for (CycleList::Cycle cycle; cycles.next(cycle);) {
    can.load(cycle.can);
    lidar.load(cycle.lidar);
    imu.load(cycle.imu);
    static_cast<void>(loop.cycle(cycle.time));
    left_over += can.used_up() && lidar.used_up() && imu.used_up() ? 0U : 1U;
  }
  replay.differences = can.differences() + lidar.differences() + imu.differences() + left_over;
  keep(replay, *vehicle, loop.journal());
}

void replay_arrivals(const RecordFolder& folder, VehicleSettings settings,
                     host::Diagnostics& diagnostics, FolderReplay& replay) {
  const Captures captures =
      read_captures(folder, settings.controller.frames_out.base_id, diagnostics);
  // SYNC is in the log, whoever sent it.
  settings.wheels.produce_sync = false;
  if (!captures.imu) {
    settings.controller.health.expects_gyro = false;
    settings.controller.dead_reckoning.use_gyro = false;
  }
  LatchedClock clock;
  ProcessorTimeCounter counter;
  NoWatchdog watchdog;
  ArrivalCanBus can{clock, captures.can};
  ArrivalSerialPort lidar{clock, &captures.lidar, settings.lidar_bauds.front()};
  ArrivalSerialPort imu{clock, captures.imu ? &*captures.imu : nullptr, settings.imu_bauds.front()};
  const auto vehicle = make_vehicle(
      settings, {.board = {can, clock, counter, watchdog}, .lidar = lidar, .imu = imu});
  LiveLoop loop{*vehicle, clock, nullptr};
  loop.start(captures.begin);
  while (vehicle->next_frame() <= captures.end) {
    static_cast<void>(loop.cycle(vehicle->next_frame()));
  }
  keep(replay, *vehicle, loop.journal());
}

}  // namespace

FolderReplay replay_folder(const RecordFolder& folder, const std::string& config,
                           host::Diagnostics& diagnostics) {
  FolderReplay replay;
  const VehicleSettings settings = settings_of(folder, config);
  replay.has_cycles = fs::exists(folder.cycles());
  if (!replay.has_cycles) {
    replay_arrivals(folder, settings, diagnostics, replay);
    return replay;
  }
  replay_cycles(folder, settings, replay);
  replay.has_result = fs::exists(folder.result());
  replay.same = replay.has_result && replay.differences == 0 &&
                host::read_file(folder.result()) == result_text(replay.journal);
  return replay;
}

}  // namespace picolo::tool
