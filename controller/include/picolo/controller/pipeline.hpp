// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// From samples to map_T_odom, in slices: what the tasks of the cycle call.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/controller/controller_config.hpp"
#include "picolo/controller/sensor_checks.hpp"
#include "picolo/localisation/pose_estimate.hpp"
#include "picolo/odometry/drive_model.hpp"
#include "picolo/undistort/pose_buffer.hpp"

namespace picolo::inline v0 {

/// Memory of a profile that the pipeline works in. Equal sizes, one element a return.
struct PipelineStorage {
  std::span<RangeReturn> first_sweep;
  std::span<RangeReturn> second_sweep;
  std::span<float> x_m;
  std::span<float> y_m;
};

/// Poses that the odometry remembers: at 100 Hz 0.64 s, which is a sweep of 10 Hz, its delays, and
/// the work on the sweep before it.
inline constexpr std::size_t kRememberedPoses = 64;

/// Where the pipeline stands with the current sweep.
enum class PipelineStage : std::uint8_t { waiting, undistorting, matching, mapping };

struct PipelineCounters {
  std::uint32_t sweeps_taken = 0;
  std::uint32_t sweeps_replaced = 0;   ///< given up while undistorting because a newer one came
  std::uint32_t sweeps_uncovered = 0;  ///< dropped: they begin before the oldest remembered pose
  std::uint32_t sweeps_refused = 0;    ///< dropped: inconsistent stamps or too many returns
  std::uint32_t increments = 0;        ///< of the wheels
  std::uint32_t bridged = 0;         ///< gaps of the wheels after which their counters started anew
  std::uint32_t ticks_refused = 0;   ///< not newer than their predecessor
  std::uint32_t ticks_left_out = 0;  ///< faster than the vehicle can be
  std::uint32_t coasted = 0;         ///< poses without wheels, see CoastConfig
};

/// The end of a match.
struct MatchVerdict {
  bool accepted = false;
  bool direction_unobservable = false;
  bool turned_by_gyro = true;  ///< odometry's turn is the gyro's; otherwise the wheels' alone
  bool guessed = false;        ///< the odometry of the sweep was carried on without wheels
  bool relocalised = false;    ///< found by a search of the whole map
  HealthReason rejection = HealthReason::none;
  Timestamp reference{};
  Pose2d odom_T_base{};         ///< odometry at `reference`
  Pose2d map_T_base{};          ///< at `reference`
  Matrix3f covariance{};        ///< of map_T_base given the map, map axes
  Matrix3f drift_covariance{};  ///< of the map against the start, map axes
  float agreement = 0.0F;       ///< see LocaliserCore::agreement
  float inlier_share = 0.0F;    ///< of the points; 1 for the first sweep, which founds the map
};

/// What the health monitor is told of a match that was not accepted.
[[nodiscard]] HealthReason why_rejected(MatchOutcome outcome);

/// One sweep at a time goes through undistortion, match and map update; a newer one waits in the
/// assembler and replaces what waits there. Cost: each call bounded by its argument. Context: cycle
/// only.
class Pipeline {
 public:
  /// Everything referred to outlives the pipeline. Precondition: config.valid(). `drive`: nullptr
  /// for two wheels on an axle, as in config.drive.
  Pipeline(const ControllerConfig& config, const PipelineStorage& storage, LocaliserCore& localiser,
           DriveModel* drive = nullptr);
  Pipeline(ControllerConfig&& config, const PipelineStorage& storage, LocaliserCore& localiser,
           DriveModel* drive = nullptr) = delete;
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;
  ~Pipeline() = default;

  void add(const ImuSample& sample);
  void add(RangeReading reading);
  /// Advances odometry and remembers its pose. Damaged counts are left out.
  void add(WheelTicks ticks);

  /// To be called after the samples of a frame: goes on without the wheels where there are none.
  void coast(Timestamp now);

  /// Handles at most `max_returns` returns of the sweep, once the poses cover it. A sweep that
  /// cannot be undistorted is dropped and counted.
  /// True when a sweep became ready in this call: see `sweep`.
  bool undistort(std::size_t max_returns);
  /// As many iterations as `max_point_iterations` allow, at least one. True when a match ended in
  /// this call: see `verdict`.
  bool match(std::size_t max_point_iterations);
  /// At most `max_slices` slices of a search, where the match has come to need one. True as for
  /// `match`.
  bool search(std::size_t max_slices);
  [[nodiscard]] bool searching() const { return localiser_.searching(); }
  /// The pose may be anywhere, see LocaliserCore.
  void verify() { localiser_.verify(false); }
  /// See LocaliserCore.
  void doubt(bool doubted) { localiser_.doubt(doubted); }
  void hold_map(bool held) { localiser_.hold_map(held); }
  /// From now on the pose is map_T_odom * odometry; `covariance` is the pose's, map axes. The end
  /// of a match that is under way is not told any more; the next match starts from here.
  void set_pose(const Pose2d& map_T_odom, const Matrix3f& covariance) {
    set_map_T_odom_ = map_T_odom;
    set_covariance_ = covariance;
    pose_was_set_ = true;
  }
  /// While paused, no new sweep is taken.
  void pause(bool paused) { paused_ = paused; }
  /// Paused, and nothing is under way.
  [[nodiscard]] bool idle() const { return paused_ && stage_ == PipelineStage::waiting; }
  /// For work on the map. Precondition: idle().
  [[nodiscard]] LocaliserCore& idle_localiser() { return localiser_; }
  /// At most `max_rays` rays into the map.
  void map(std::size_t max_rays);

  [[nodiscard]] PipelineStage stage() const { return stage_; }
  /// The sweep at hand, valid until the next one is taken.
  [[nodiscard]] const UndistortedSweep& sweep() const { return undistorter_.result(); }
  [[nodiscard]] const MatchVerdict& verdict() const { return verdict_; }
  [[nodiscard]] const LocaliserCore& localiser() const { return localiser_; }
  [[nodiscard]] const DeadReckoning& odometry() const { return dead_reckoning_; }
  /// odom_T_base at its newest; the origin at `otherwise` as long as the wheels gave nothing.
  [[nodiscard]] StampedPose newest_pose(Timestamp otherwise) const {
    return poses_.size() > 0 ? poses_.newest() : StampedPose{otherwise, {}};
  }
  /// Wheels and gyro turn differently.
  [[nodiscard]] bool turns_disagree() const { return turn_check_.disagrees(); }
  /// Sensors whose own streams cannot be true.
  [[nodiscard]] SensorDoubts doubts() const;
  /// The vehicle leans too far for a map of the plane.
  [[nodiscard]] bool tilted() const { return gravity_check_.tilted(); }
  /// End of the newest complete sweep; the epoch before the first.
  [[nodiscard]] Timestamp last_sweep_end() const { return last_sweep_end_; }
  [[nodiscard]] const PipelineCounters& counters() const { return counters_; }
  [[nodiscard]] const SweepCounters& sweep_counters() const { return sweeps_.counters(); }

 private:
  void bridge(Timestamp to);
  void doubt(SensorIndex sensor, Timestamp stamp);
  void doubt_wheels(std::uint8_t encoders, Timestamp stamp);
  void take_sweep();
  [[nodiscard]] Duration since_compared() const;
  void learn_twist();
  void learn_gyro_bias();
  /// True when the end of the match is to be told.
  [[nodiscard]] bool conclude();

  UndistortConfig undistort_;
  Duration max_bridge_;
  CoastConfig coast_;
  Duration max_lidar_age_;
  Duration lidar_age_;
  LocaliserCore& localiser_;
  float gyro_gain_;
  DriveModelOf<DifferentialDrive> two_wheels_;
  DriveModel& drive_;
  WheelGate gate_;
  const PlausibilityConfig& plausibility_;
  TurnCheck turn_check_;
  WheelStepCheck wheel_check_;
  GyroCheck gyro_check_;
  GravityCheck gravity_check_;
  SweepCheck sweep_check_;
  DeadReckoning dead_reckoning_;
  std::array<StampedPose, kRememberedPoses> pose_storage_{};
  PoseBufferCore poses_;
  SweepAssemblerCore sweeps_;
  UndistorterCore undistorter_;
  MatchVerdict verdict_{};
  Timestamp last_sweep_end_{};
  Timestamp last_reading_{};
  Timestamp newest_sample_{};                 // of wheels and IMU
  std::array<Timestamp, 4> doubted_until_{};  // wheels, lidar, gyro
  bool moving_ = false;                       // the wheels
  Timestamp last_ticks_{};
  Twist2 coast_twist_{};
  PipelineStage stage_ = PipelineStage::waiting;
  Pose2d set_map_T_odom_{};
  Matrix3f set_covariance_{};
  bool pose_was_set_ = false;
  bool paused_ = false;
  bool begins_apart_;         // the match, in a frame after the undistortion
  bool undistorted_ = false;  // the sweep at hand, whose match has not begun
  bool coasting_ = false;
  bool guessed_ = false;  // odometry since the last sweep that was begun
  PipelineCounters counters_{};
};

}  // namespace picolo::inline v0
