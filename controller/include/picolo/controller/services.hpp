// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the controller is given beside its devices: the keeping of maps and calibrations, and
/// wheels of another model than the configured one.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/controller/frames_out.hpp"
#include "picolo/controller/pipeline.hpp"
#include "picolo/core/result.hpp"
#include "picolo/localisation/localiser.hpp"
#include "picolo/sensing/imu_sample.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

/// Keeps maps. One job at a time, in slices; from begin to the last step no sweep is worked on.
/// `localiser` is always the same and idle. Context: cycle only.
class MapService {
 public:
  /// `ok`: a job has begun. `invalid_argument`: no such slot. Anything else: it cannot be done.
  virtual Status begin_save(std::uint8_t slot, LocaliserCore& localiser) = 0;
  virtual Status begin_load(std::uint8_t slot, LocaliserCore& localiser) = 0;
  /// One bounded slice of the job. `not_ready`: more to do. `ok`: done; a loaded map is in use.
  /// Anything else: failed.
  virtual Status step(LocaliserCore& localiser) = 0;

 protected:
  MapService() = default;
  MapService(const MapService&) = default;
  MapService& operator=(const MapService&) = default;
  ~MapService() = default;
};

/// A calibration that runs on the target while the vehicle drives. All calls bounded. Context:
/// cycle only.
class CalibrationService {
 public:
  /// `ok`: begun. `invalid_argument`: no such procedure. `not_ready`: one is under way.
  virtual Status start(std::uint8_t procedure, Timestamp now) = 0;
  /// `not_ready`: none is under way.
  virtual Status cancel(Timestamp now) = 0;

  // What the controller hears, whether a calibration is under way or not.
  virtual void add(const WheelTicks& ticks) = 0;
  virtual void add(const ImuSample& sample) = 0;
  /// A sweep at one instant, in base; its points are valid during the call only.
  virtual void add(const UndistortedSweep& sweep) = 0;
  /// One bounded slice of background work, once a minor frame.
  virtual void step(Timestamp now) = 0;

  [[nodiscard]] virtual CalibrationProgress progress() const = 0;
  [[nodiscard]] virtual CalibrationHint hint() const = 0;
  /// Answers to tell, 0 unless the last calibration was done.
  [[nodiscard]] virtual std::size_t value_count() const = 0;
  /// Precondition: index < value_count().
  [[nodiscard]] virtual CalibrationValue value(std::size_t index) const = 0;

 protected:
  CalibrationService() = default;
  CalibrationService(const CalibrationService&) = default;
  CalibrationService& operator=(const CalibrationService&) = default;
  ~CalibrationService() = default;
};

/// nullptr: the commands answer `unsupported`. Everything outlives the controller.
struct ControllerServices {
  MapService* maps = nullptr;
  CalibrationService* calibration = nullptr;  ///< of two wheels on an axle; not used for others
  /// Of a vehicle with other wheels than two on an axle; nullptr: those of ControllerConfig::drive.
  DriveModel* drive = nullptr;
};

}  // namespace picolo::inline v0
