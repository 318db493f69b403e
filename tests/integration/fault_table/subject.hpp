// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A drive under judgement: simulated or recorded, the installed controller, faulty devices.
#pragma once

#include "fault.hpp"
#include "picolo/localisation/pose_estimate.hpp"

namespace picolo::test {

/// One published pose beside the truth. Plain: it lies in memory that processes share.
struct Publication {
  Timestamp now{};
  Timestamp stamp{};
  Pose2d map_T_base{};
  Pose2d odom_T_base{};
  HealthState state = HealthState::initialising;
  HealthReason reason = HealthReason::starting;
  Pose2d truth{};     ///< map_T_base at `stamp`, where `knows_truth`
  double nees = 0.0;  ///< simulated only: with the covariances of match and drift
  bool knows_truth = false;
  bool tilted = false;
  bool accelerometer_doubted = false;
  bool imu_silent = false;
};

class Subject {
 public:
  Subject() = default;
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;
  virtual ~Subject() = default;

  virtual void run_frame() = 0;
  [[nodiscard]] virtual Timestamp now() const = 0;
  [[nodiscard]] virtual Publication publication() const = 0;
  [[nodiscard]] virtual bool moving() const = 0;
  [[nodiscard]] virtual bool finished() const { return false; }
  /// Leans by 15 deg, `after` from now on, for `length`; only the accelerometer feels it.
  virtual void lean(Duration /*after*/, Duration /*length*/) {}
  /// From the next frame on.
  virtual void inject(const Fault& fault) = 0;
};

}  // namespace picolo::test
