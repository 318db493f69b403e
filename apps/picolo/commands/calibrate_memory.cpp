// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "commands/calibrate.hpp"
#include "picolo/calibration/extrinsic_calibration.hpp"
#include "picolo/calibration/gyro_calibration.hpp"
#include "picolo/calibration/imu_mount.hpp"
#include "picolo/calibration/joint_streaming.hpp"
#include "picolo/calibration/linear_calibration.hpp"
#include "picolo/calibration/motion_check.hpp"
#include "picolo/calibration/time_offset.hpp"
#include "picolo/calibration/wheel_streaming.hpp"
#include "picolo/controller/calibration_routine.hpp"
#include "picolo/controller/scan_odometer.hpp"
#include "picolo/host/json.hpp"

namespace picolo::tool {

ExitCode calibrate_memory_command(const CalibrateOptions& options) {
  host::Json bytes;
  bytes["linear"] = sizeof(LinearCalibration);
  bytes["wheels"] = sizeof(WheelStreaming);
  bytes["extrinsic"] = sizeof(ExtrinsicCalibration);
  bytes["joint"] = sizeof(JointStreaming);
  bytes["motion_check"] = sizeof(MotionCheck);
  bytes["time_offset_41_lags"] = sizeof(TimeOffset<41, 128>);
  bytes["time_offset_101_lags"] = sizeof(TimeOffset<101, 128>);
  bytes["gyro"] = sizeof(GyroCalibration);
  bytes["imu_mount"] = sizeof(ImuMountCalibration);
  bytes["routine"] = sizeof(CalibrationRoutine);
  bytes["scan_odometer_180_points"] = sizeof(ScanOdometer<180>);
  if (options.common.json) {
    fmt::print("{}\n", host::to_text({{"bytes", bytes}}));
    return ExitCode::done;
  }
  fmt::print("Bytes of state of the single-pass estimators, whatever the number of samples:\n");
  for (const auto& [name, size] : bytes.items()) {
    fmt::print("{:22} {:>6}\n", name, size.get<std::size_t>());
  }
  return ExitCode::done;
}

}  // namespace picolo::tool
