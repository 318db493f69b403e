// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The installed controller with its drivers on any ports, whatever its profile.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "live/vehicle_settings.hpp"
#include "picolo/controller/controller.hpp"
#include "picolo/hal/byte_store.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/host/map_file.hpp"

namespace picolo::tool {

/// Time stands still during a frame: all tasks, and a replay, see the same instant.
class LatchedClock final : public Clock {
 public:
  void latch(Timestamp now) { now_ = now; }
  [[nodiscard]] Timestamp now() override { return now_; }

 private:
  Timestamp now_{};
};

class NoWatchdog final : public Watchdog {
 public:
  void stroke() override {}
};

/// What a person wants to know of the devices.
struct LiveFigures {
  ControllerCounters controller{};
  LocaliserCounters localiser{};
  CommandCounters commands{};
  std::uint32_t frames_sent = 0;
  std::uint32_t frames_refused = 0;
  std::uint32_t slipped = 0;
};

class LiveVehicle {
 public:
  LiveVehicle() = default;
  LiveVehicle(const LiveVehicle&) = delete;
  LiveVehicle& operator=(const LiveVehicle&) = delete;
  virtual ~LiveVehicle() = default;

  virtual Status start() = 0;
  virtual Status run_frame() = 0;
  /// Lets devices rest that can (lidar motors). `not_ready`: call again a little later.
  virtual Status stop() = 0;
  /// Why a device gives nothing, with the cure; empty when unknown.
  [[nodiscard]] virtual std::string trouble() const = 0;
  [[nodiscard]] virtual devices::Counters lidar_counters() const = 0;
  [[nodiscard]] virtual devices::Counters imu_counters() const = 0;
  [[nodiscard]] virtual Timestamp next_frame() const = 0;
  [[nodiscard]] virtual const PoseEstimate& estimate() const = 0;
  [[nodiscard]] virtual LiveFigures figures() const = 0;
  [[nodiscard]] virtual host::OccupancyImage map() const = 0;
};

/// Of the file in which a vehicle keeps its maps.
inline constexpr ByteStoreGeometry kMapStoreGeometry{
    .size = std::size_t{16} << 20U, .sector = 4096, .granule = 8};

/// Everything referred to outlives the vehicle.
struct LivePorts {
  Board board;
  SerialPort& lidar;
  SerialPort& imu;
  ByteStore* store = nullptr;  ///< for the maps and calibrations of commands
};

/// Throws UserError (usage) for a profile or a driver that does not exist or cannot be set up so.
[[nodiscard]] std::unique_ptr<LiveVehicle> make_vehicle(const VehicleSettings& settings,
                                                        const LivePorts& ports);

}  // namespace picolo::tool
