// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/live_vehicle.hpp"

#include <optional>
#include <stdexcept>

#include "picolo/controller/calibration_store.hpp"
#include "picolo/controller/onboard_calibration.hpp"
#include "picolo/controller/stored_maps.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/map_image.hpp"

namespace picolo::tool {
namespace {

constexpr std::size_t kCalibrationPoints = 720;

template <Profile P>
class VehicleOf final : public LiveVehicle {
 public:
  VehicleOf(const VehicleSettings& settings, const LivePorts& ports)
      : wheels_(devices::make_wheels(settings.wheels_name, ports.board.can, settings.wheels)),
        lidar_(devices::make_lidar(settings.lidar_name, ports.lidar, settings.lidar)),
        imu_(devices::make_imu(settings.imu_name, ports.imu, settings.imu)),
        config_(open_stores(settings.controller, ports.store)),
        calibration_(onboard_calibration(config_), records_ ? &*records_ : nullptr),
        controller_(ports.board, *wheels_, *lidar_, *imu_, events_, config_,
                    {.maps = maps_ ? &*maps_ : nullptr, .calibration = &calibration_.core()}) {}

  Status start() override { return controller_.start(); }
  Status run_frame() override { return controller_.run_frame(); }
  Status stop() override {
    const Status imu = imu_->stop();
    const Status lidar = lidar_->stop();
    return imu == Status::not_ready ? imu : lidar;
  }
  [[nodiscard]] std::string trouble() const override { return lidar_->trouble(); }
  [[nodiscard]] devices::Counters lidar_counters() const override { return lidar_->counters(); }
  [[nodiscard]] devices::Counters imu_counters() const override { return imu_->counters(); }
  [[nodiscard]] Timestamp next_frame() const override { return controller_.next_frame(); }
  [[nodiscard]] const PoseEstimate& estimate() const override { return controller_.estimate(); }
  [[nodiscard]] LiveFigures figures() const override {
    return {.controller = controller_.counters(),
            .localiser = controller_.pipeline().localiser().counters(),
            .commands = controller_.commands().counters(),
            .frames_sent = controller_.reporter().sent(),
            .frames_refused = controller_.reporter().refused(),
            .slipped = controller_.schedule().frame_counters().slipped};
  }
  [[nodiscard]] host::OccupancyImage map() const override {
    return host::crop(host::image_of(controller_.pipeline().localiser().map()), 10);
  }

 private:
  /// Calibrations in the first two sectors, maps behind them. What was calibrated replaces what the
  /// configuration says.
  ControllerConfig open_stores(ControllerConfig config, ByteStore* store) {
    if (store == nullptr) { return config; }
    CalibrationRecord record;
    const Status found = records_.emplace(*store).load(record);
    if (is_ok(found)) { apply(record, config); }
    maps_.emplace(*store, MapStoreConfig{.address = 2 * store->geometry().sector});
    return config;
  }

  std::optional<StoredMaps> maps_;
  std::optional<CalibrationStore> records_;
  std::unique_ptr<devices::Wheels> wheels_;
  std::unique_ptr<devices::Lidar> lidar_;
  std::unique_ptr<devices::Imu> imu_;
  ControllerConfig config_;
  OnboardCalibration<kCalibrationPoints> calibration_;
  EventRing events_{};
  Controller<P, devices::Wheels, devices::Lidar, devices::Imu> controller_;
};

std::unique_ptr<LiveVehicle> make(const VehicleSettings& settings, const LivePorts& ports) {
  if (settings.profile == "room") {
    return std::make_unique<VehicleOf<RoomProfile>>(settings, ports);
  }
  if (settings.profile == "hall") {
    return std::make_unique<VehicleOf<HallProfile>>(settings, ports);
  }
  if (settings.profile == "site") {
    return std::make_unique<VehicleOf<SiteProfile>>(settings, ports);
  }
  throw std::invalid_argument{"there is no profile '" + settings.profile +
                              "'; give room, hall or site"};
}

}  // namespace

std::unique_ptr<LiveVehicle> make_vehicle(const VehicleSettings& settings, const LivePorts& ports) {
  try {
    return make(settings, ports);
  } catch (const std::invalid_argument& error) {
    throw host::UserError{host::ExitCode::usage, "configuration", error.what(),
                          "see picolo run --help"};
  }
}

}  // namespace picolo::tool
