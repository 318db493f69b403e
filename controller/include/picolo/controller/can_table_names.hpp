// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The enumerations of the CAN protocol with their names on the wire; append only.
#pragma once

#include <array>
#include <cstdint>

namespace picolo::inline v0 {

struct CanName {
  std::uint8_t value = 0;
  const char* text = "";
};

/// What the controller does with what it sees.
enum class OperatingMode : std::uint8_t {
  mapping = 0,     ///< localises and lets the map grow
  localising = 1,  ///< localises in the map as it is
};

/// Where an on-target calibration stands.
enum class CalibrationPhase : std::uint8_t {
  idle = 0,
  collecting = 1,
  solving = 2,
  done = 3,
  refused = 4,
  aborted = 5,
  checking = 6,  ///< whether the data suffices
  saving = 7,
  standstill = 8,  ///< waiting for it, then averaging the gyro
  verifying = 9,   ///< the answer against fresh data
};

/// What to drive next for a calibration.
enum class DriveAdvice : std::uint8_t {
  none = 0,
  stand_still = 1,
  turn_left = 2,       ///< on the spot
  turn_right = 3,      ///< on the spot
  drive_straight = 4,  ///< 3 m
  change_speed = 5,    ///< turn to and fro, briskly
  drive_on = 6,        ///< anything with turns
};

enum class CommandResult : std::uint8_t {
  done = 0,
  started = 1,           ///< a second reply tells the end
  corrupt = 2,           ///< wrong CRC, counter or length: damaged, or not from our commander
  repeated = 3,          ///< counter of a command already taken
  stale = 4,             ///< its tick is too old, or it came out of order
  invalid_argument = 5,  ///< a value outside of its range
  busy = 6,              ///< something of the kind is under way
  unsupported = 7,       ///< this controller cannot do it
  failed = 8,
};
inline constexpr std::size_t kCommandResults = 9;

/// Order of the counters in PicoloCounter.
enum class CounterIndex : std::uint8_t {
  can_frames,
  foreign_frames,
  ticks,
  ticks_lost,
  readings,
  imu_samples,
  frames_sent,
  frames_refused,
  impersonated,
  sweeps_taken,
  sweeps_replaced,
  sweeps_uncovered,
  sweeps_refused,
  matched,
  rejected,
  searched,
  overruns,
  frames_slipped,
  events,
  commands_accepted,
  commands_corrupt,
  commands_repeated,
  commands_stale,
  commands_refused,
  can_lost,
  can_errors,
  can_restarts,
};
inline constexpr std::size_t kCounterCount = 27;

namespace can_table {

inline constexpr std::array kHealthStateNames{
    CanName{0, "initialising"}, CanName{1, "tracking"}, CanName{2, "degraded"},
    CanName{3, "lost"},         CanName{4, "fault"},    CanName{5, "relocalising"}};
inline constexpr std::array kHealthReasonNames{CanName{0, "none"},
                                               CanName{1, "starting"},
                                               CanName{2, "lidar_silent"},
                                               CanName{3, "wheels_silent"},
                                               CanName{4, "gyro_silent"},
                                               CanName{5, "match_rejected"},
                                               CanName{6, "direction_unobservable"},
                                               CanName{7, "too_few_points"},
                                               CanName{8, "out_of_map"},
                                               CanName{9, "relocalising"},
                                               CanName{10, "configuration"},
                                               CanName{11, "overrun"},
                                               CanName{12, "sensors_disagree"},
                                               CanName{13, "tilted"},
                                               CanName{14, "turn_unverified"},
                                               CanName{15, "ambiguous"},
                                               CanName{16, "unproven"}};
inline constexpr std::array kOperatingModeNames{CanName{0, "mapping"}, CanName{1, "localising"}};
inline constexpr std::array kEventCodeNames{
    CanName{0, "started"},          CanName{1, "state_changed"},  CanName{2, "reason_changed"},
    CanName{3, "overrun"},          CanName{4, "frames_slipped"}, CanName{5, "sweep_replaced"},
    CanName{6, "sweep_dropped"},    CanName{7, "pose_jump"},      CanName{8, "device_lost"},
    CanName{9, "device_back"},      CanName{10, "pose_set"},      CanName{11, "mode_set"},
    CanName{12, "command_refused"}, CanName{13, "impersonated"},  CanName{14, "sensor_doubted"},
    CanName{15, "watchdog_reset"}};
inline constexpr std::array kCalibrationPhaseNames{
    CanName{0, "idle"},     CanName{1, "collecting"}, CanName{2, "solving"},
    CanName{3, "done"},     CanName{4, "refused"},    CanName{5, "aborted"},
    CanName{6, "checking"}, CanName{7, "saving"},     CanName{8, "standstill"},
    CanName{9, "verifying"}};
inline constexpr std::array kDriveAdviceNames{
    CanName{0, "none"},       CanName{1, "stand_still"},    CanName{2, "turn_left"},
    CanName{3, "turn_right"}, CanName{4, "drive_straight"}, CanName{5, "change_speed"},
    CanName{6, "drive_on"}};
inline constexpr std::array kRefusalReasonNames{CanName{0, "none"},
                                                CanName{1, "too_little_data"},
                                                CanName{2, "standing_still"},
                                                CanName{3, "straight_only"},
                                                CanName{4, "pure_rotation"},
                                                CanName{5, "constant_arc"},
                                                CanName{6, "one_turn_direction"},
                                                CanName{7, "no_translation"},
                                                CanName{8, "encoder_disconnected"},
                                                CanName{9, "encoder_swapped"},
                                                CanName{10, "encoder_reversed"},
                                                CanName{11, "constant_velocity"},
                                                CanName{12, "inconsistent"},
                                                CanName{13, "aborted"},
                                                CanName{14, "numerically_singular"},
                                                CanName{15, "not_stored"}};
inline constexpr std::array kParameterNames{CanName{0, "none"},
                                            CanName{1, "wheel_radius_left"},
                                            CanName{2, "wheel_radius_right"},
                                            CanName{3, "track_width"},
                                            CanName{4, "lidar_x"},
                                            CanName{5, "lidar_y"},
                                            CanName{6, "lidar_yaw"},
                                            CanName{7, "time_offset"},
                                            CanName{8, "gyro_bias"},
                                            CanName{9, "gyro_scale"},
                                            CanName{10, "gyro_yaw"},
                                            CanName{11, "gyro_offset"},
                                            CanName{12, "linear_correction"}};
inline constexpr std::array kCommandNames{
    CanName{0, "set_pose"},   CanName{1, "set_mode"},          CanName{2, "save_map"},
    CanName{3, "load_map"},   CanName{4, "start_calibration"}, CanName{5, "abort_calibration"},
    CanName{6, "read_events"}};
inline constexpr std::array kCommandResultNames{
    CanName{0, "done"},     CanName{1, "started"},     CanName{2, "corrupt"},
    CanName{3, "repeated"}, CanName{4, "stale"},       CanName{5, "invalid_argument"},
    CanName{6, "busy"},     CanName{7, "unsupported"}, CanName{8, "failed"}};
inline constexpr std::array kCounterNames{CanName{0, "can_frames"},
                                          CanName{1, "foreign_frames"},
                                          CanName{2, "ticks"},
                                          CanName{3, "ticks_lost"},
                                          CanName{4, "readings"},
                                          CanName{5, "imu_samples"},
                                          CanName{6, "frames_sent"},
                                          CanName{7, "frames_refused"},
                                          CanName{8, "impersonated"},
                                          CanName{9, "sweeps_taken"},
                                          CanName{10, "sweeps_replaced"},
                                          CanName{11, "sweeps_uncovered"},
                                          CanName{12, "sweeps_refused"},
                                          CanName{13, "matched"},
                                          CanName{14, "rejected"},
                                          CanName{15, "searched"},
                                          CanName{16, "overruns"},
                                          CanName{17, "frames_slipped"},
                                          CanName{18, "events"},
                                          CanName{19, "commands_accepted"},
                                          CanName{20, "commands_corrupt"},
                                          CanName{21, "commands_repeated"},
                                          CanName{22, "commands_stale"},
                                          CanName{23, "commands_refused"},
                                          CanName{24, "can_lost"},
                                          CanName{25, "can_errors"},
                                          CanName{26, "can_restarts"}};
static_assert(kCounterNames.size() == kCounterCount);
static_assert(kCommandResultNames.size() == kCommandResults);

}  // namespace can_table
}  // namespace picolo::inline v0
