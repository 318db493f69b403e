// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The calibration routine as the controller's service: started, watched and aborted over CAN.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/controller/calibration_routine.hpp"
#include "picolo/controller/controller_config.hpp"
#include "picolo/controller/scan_odometer.hpp"
#include "picolo/controller/services.hpp"

namespace picolo::inline v0 {

/// Procedures of PicoloStartCalibration.
inline constexpr std::uint8_t kCalibrateAll = 0;
inline constexpr std::uint8_t kFinishCalibration = 15;  ///< that is all: check what there is

struct OnboardCalibrationConfig {
  CalibrationRoutineConfig routine{};
  ScanOdometerConfig scans{};
  /// Neighbours of a spinning lidar stand further apart than those of a dense scan.
  PlIcpConfig matcher{.line_radius_m = 0.12F};
  Pose2d base_T_lidar{};  ///< as the controller has it; sweeps come in base
  /// In each minor frame, each either of the scan match or of the routine.
  std::size_t slices = 1;
};

/// What the controller knows about its vehicle, for the calibration of it.
[[nodiscard]] OnboardCalibrationConfig onboard_calibration(const ControllerConfig& config);

/// Replaces what a calibration found: wheels, lidar pose, clock of the lidar, scale of the gyro. A
/// record that is not calibrated changes nothing.
void apply(const CalibrationRecord& record, ControllerConfig& config);

/// The logic behind `OnboardCalibration`. Context: cycle only.
class OnboardCalibrationCore final : public CalibrationService {
 public:
  OnboardCalibrationCore(const OnboardCalibrationConfig& config, CalibrationStore* store,
                         ScanOdometerCore& scans)
      : config_(config), routine_(config.routine, store), scans_(scans) {}

  Status start(std::uint8_t procedure, Timestamp now) override;
  Status cancel(Timestamp now) override;
  void add(const WheelTicks& ticks) override { routine_.add(ticks); }
  void add(const ImuSample& sample) override { routine_.add(sample); }
  void add(const UndistortedSweep& sweep) override;
  void step(Timestamp now) override;
  [[nodiscard]] CalibrationProgress progress() const override;
  [[nodiscard]] CalibrationHint hint() const override;
  [[nodiscard]] std::size_t value_count() const override;
  [[nodiscard]] CalibrationValue value(std::size_t index) const override;
  [[nodiscard]] const CalibrationRoutine& routine() const { return routine_; }

 private:
  OnboardCalibrationConfig config_;
  CalibrationRoutine routine_;
  ScanOdometerCore& scans_;
  Timestamp now_{};
  bool routine_first_ = false;
};

/// Memory: 58 bytes a point and about 26 KiB. `Points`: beams of a sweep that are matched, thinned
/// out evenly.
template <std::size_t Points>
class OnboardCalibration {
 public:
  /// `store` may be null; it outlives this.
  explicit OnboardCalibration(const OnboardCalibrationConfig& config,
                              CalibrationStore* store = nullptr)
      : scans_(config.scans, config.matcher), core_(config, store, scans_.core()) {}
  OnboardCalibration(const OnboardCalibration&) = delete;
  OnboardCalibration& operator=(const OnboardCalibration&) = delete;
  ~OnboardCalibration() = default;
  [[nodiscard]] OnboardCalibrationCore& core() { return core_; }
  [[nodiscard]] const OnboardCalibrationCore& core() const { return core_; }
  [[nodiscard]] const ScanOdometerCounters& scans() const { return scans_.core().counters(); }

 private:
  ScanOdometer<Points> scans_;
  OnboardCalibrationCore core_;
};

}  // namespace picolo::inline v0
