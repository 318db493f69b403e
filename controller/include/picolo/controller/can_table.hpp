// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The one table of picolo's own CAN protocol: codec, DBC file and docs/can_protocol.md follow from
/// it. Names and raw values go over the wire: append only.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/controller/can_table_names.hpp"

namespace picolo::inline v0 {

/// How a signal's raw value is meant.
enum class CanKind : std::uint8_t {
  number,  ///< raw / per_unit; the code `not_available` says: unknown, or beyond the range
  count,   ///< modulo 2^bits
  name,    ///< one of `names`
};

/// Where a signal lies and how it counts. Little-endian; `start_bit` is the least significant bit,
/// counted as in a DBC file with @1.
struct CanField {
  std::uint8_t start_bit = 0;
  std::uint8_t bits = 0;
  bool is_signed = false;
  CanKind kind = CanKind::number;
  std::int32_t per_unit = 1;  ///< raw value of one unit

  [[nodiscard]] constexpr std::int64_t lowest() const {
    return is_signed ? -(std::int64_t{1} << (bits - 1)) : 0;
  }
  [[nodiscard]] constexpr std::int64_t highest() const {
    return (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
  }
  /// Signed: the lowest value; unsigned: all bits set.
  [[nodiscard]] constexpr std::int64_t not_available() const {
    return is_signed ? lowest() : highest();
  }
};

/// With its words for people.
struct CanSignal : CanField {
  const char* name = "";
  const char* unit = "";
  const char* meaning = "";
  std::span<const CanName> names{};
};

/// Every frame has 8 bytes: CRC in byte 0, counter in the low half of byte 1, then signals.
struct CanMessage {
  const char* name = "";
  std::uint8_t offset = 0;  ///< of its identifier from the base identifier
  std::uint8_t every = 0;   ///< of so many reports (25 ms); 0: when there is something to say
  bool is_command = false;  ///< to the controller; otherwise from it
  std::span<const CanSignal> signals{};
  const char* meaning = "";
};

inline constexpr std::size_t kMaxCanSignals = 8;  ///< in one message

/// A message without words: all that the firmware keeps of the table.
struct CanLayout {
  std::uint8_t offset = 0;
  std::uint8_t size = 0;
  std::array<CanField, kMaxCanSignals> fields{};
};
[[nodiscard]] constexpr CanLayout layout_of(const CanMessage& message) {
  CanLayout layout{.offset = message.offset};
  for (const CanSignal& signal : message.signals) {
    layout.fields[layout.size] = signal;
    ++layout.size;
  }
  return layout;
}

inline constexpr std::uint8_t kCanPayloadBit = 12;  ///< first bit behind CRC and counter
/// Identifiers from the base on: the controller's own, then the commands to it.
inline constexpr std::uint16_t kCanOwnIds = 16;
inline constexpr std::uint16_t kCanCommandIds = 16;
/// E2E data identifier of a message: this plus its offset, whatever the base identifier.
inline constexpr std::uint16_t kCanDataIdBase = 0x50C0;

namespace can_table {

inline constexpr std::array kPoseSignals{
    CanSignal{{12, 19, true, CanKind::number, 500}, "x_m", "m", "of map_T_base"},
    CanSignal{{31, 19, true, CanKind::number, 500}, "y_m", "m", "of map_T_base"},
    CanSignal{{50, 14, true, CanKind::number, 2500}, "yaw_rad", "rad", "of map_T_base"}};
inline constexpr std::array kHealthSignals{
    CanSignal{{12, 3, false, CanKind::name, 1},
              "state",
              "",
              "how far the pose may be trusted",
              kHealthStateNames},
    CanSignal{{15, 5, false, CanKind::name, 1}, "reason", "", "why", kHealthReasonNames},
    CanSignal{{20, 2, false, CanKind::name, 1},
              "mode",
              "",
              "what the controller does",
              kOperatingModeNames},
    CanSignal{{22, 8, false, CanKind::count, 4},
              "tick",
              "s",
              "the controller's time; commands repeat the newest one"},
    CanSignal{
        {30, 8, false, CanKind::number, 100}, "match_age_s", "s", "since the last accepted match"},
    CanSignal{{38, 13, false, CanKind::number, 1000},
              "position_sigma_m",
              "m",
              "root of the trace of the position's covariance"},
    CanSignal{{51, 13, false, CanKind::number, 5000}, "yaw_sigma_rad", "rad", ""}};
inline constexpr std::array kTwistSignals{
    CanSignal{{12, 18, true, CanKind::number, 10000}, "vx_mps", "m/s", "forward, of base in base"},
    CanSignal{{30, 16, true, CanKind::number, 10000}, "vy_mps", "m/s", "to the left"},
    CanSignal{{46, 18, true, CanKind::number, 10000}, "omega_radps", "rad/s", "counter-clockwise"}};
inline constexpr std::array kTimeSignals{
    CanSignal{{12, 48, false, CanKind::count, 1},
              "stamp_us",
              "us",
              "instant of pose and twist of the same counter, on the controller's clock"}};
inline constexpr std::array kSigmaSignals{
    CanSignal{{12, 17, false, CanKind::number, 10000}, "sigma_x_m", "m", "map axes"},
    CanSignal{{29, 17, false, CanKind::number, 10000}, "sigma_y_m", "m", "map axes"},
    CanSignal{{46, 17, false, CanKind::number, 10000}, "sigma_yaw_rad", "rad", ""}};
inline constexpr std::array kCorrelationSignals{
    CanSignal{{12, 8, true, CanKind::number, 100}, "match_xy", "", "of the match's covariance"},
    CanSignal{{20, 8, true, CanKind::number, 100}, "match_xyaw", "", ""},
    CanSignal{{28, 8, true, CanKind::number, 100}, "match_yyaw", "", ""},
    CanSignal{{36, 8, true, CanKind::number, 100}, "drift_xy", "", "of the drift's covariance"},
    CanSignal{{44, 8, true, CanKind::number, 100}, "drift_xyaw", "", ""},
    CanSignal{{52, 8, true, CanKind::number, 100}, "drift_yyaw", "", ""}};
inline constexpr std::array kEventSignals{
    CanSignal{
        {12, 16, false, CanKind::count, 1}, "index", "", "of the event since the ring's start"},
    CanSignal{{28, 6, false, CanKind::name, 1}, "code", "", "what happened", kEventCodeNames},
    CanSignal{{34, 3, false, CanKind::name, 1}, "from", "", "state before", kHealthStateNames},
    CanSignal{{37, 3, false, CanKind::name, 1}, "to", "", "state after", kHealthStateNames},
    CanSignal{{40, 6, false, CanKind::name, 1}, "reason", "", "after it", kHealthReasonNames},
    CanSignal{
        {46, 18, true, CanKind::number, 1}, "argument", "", "by code, see docs/controller.md"}};
inline constexpr std::array kEventTimeSignals{
    CanSignal{{12, 16, false, CanKind::count, 1}, "index", "", "of the event it belongs to"},
    CanSignal{{28, 36, false, CanKind::count, 1},
              "stamp_ms",
              "ms",
              "on the clock of the run that wrote it"}};
inline constexpr std::array kCounterSignals{
    CanSignal{{12, 8, false, CanKind::name, 1}, "which", "", "which counter", kCounterNames},
    CanSignal{{20, 32, false, CanKind::count, 1}, "value", "", "since the start, never reset"}};
inline constexpr std::array kCalibrationSignals{
    CanSignal{{12, 4, false, CanKind::name, 1}, "phase", "", "", kCalibrationPhaseNames},
    CanSignal{{16, 4, false, CanKind::count, 1}, "procedure", "", "as asked for"},
    CanSignal{{20, 7, false, CanKind::number, 1}, "progress", "%", ""},
    CanSignal{
        {27, 6, false, CanKind::name, 1}, "reason", "", "why it is refused", kRefusalReasonNames},
    CanSignal{{33, 6, false, CanKind::name, 1},
              "parameter",
              "",
              "the first one that cannot be told",
              kParameterNames},
    CanSignal{{39, 16, false, CanKind::number, 1}, "samples", "", "used so far"},
    CanSignal{{55, 9, false, CanKind::number, 1}, "elapsed_s", "s", "since its start"}};
inline constexpr std::array kCalibrationValueSignals{
    CanSignal{
        {12, 6, false, CanKind::name, 1}, "parameter", "", "which parameter", kParameterNames},
    CanSignal{{18, 30, true, CanKind::number, 1'000'000},
              "value",
              "",
              "in the parameter's unit: m, rad, s or rad/s"},
    CanSignal{{48, 16, false, CanKind::number, 1'000'000}, "sigma", "", "standard deviation"}};
inline constexpr std::array kCalibrationHintSignals{
    CanSignal{
        {12, 4, false, CanKind::name, 1}, "advice", "", "what to drive next", kDriveAdviceNames},
    CanSignal{{16, 7, false, CanKind::number, 1}, "wheels", "%", "radii: the smaller of both"},
    CanSignal{{23, 7, false, CanKind::number, 1}, "track", "%", "gathered of what is needed"},
    CanSignal{{30, 7, false, CanKind::number, 1}, "lidar_xy", "%", "the smaller of both"},
    CanSignal{{37, 7, false, CanKind::number, 1}, "lidar_yaw", "%", ""},
    CanSignal{{44, 7, false, CanKind::number, 1}, "time_offset", "%", ""},
    CanSignal{{51, 7, false, CanKind::number, 1}, "gyro", "%", "scale; without a gyro 127"}};
inline constexpr std::array kReplySignals{
    CanSignal{
        {12, 4, false, CanKind::name, 1}, "command", "", "the command answered", kCommandNames},
    CanSignal{{16, 4, false, CanKind::count, 1}, "command_counter", "", "that command's counter"},
    CanSignal{{20, 4, false, CanKind::name, 1}, "result", "", "", kCommandResultNames},
    CanSignal{{24, 8, false, CanKind::count, 1}, "detail", "", "slot, mode or procedure of it"},
    CanSignal{{32, 16, false, CanKind::count, 1}, "accepted", "", "commands taken since the start"},
    CanSignal{
        {48, 16, false, CanKind::count, 1}, "refused", "", "commands refused since the start"}};

inline constexpr CanSignal kTick{
    {12, 8, false, CanKind::count, 4}, "tick", "s", "the newest tick seen in Health"};
inline constexpr std::array kSetPoseSignals{
    kTick, CanSignal{{20, 16, true, CanKind::number, 50}, "x_m", "m", "of map_T_base, now"},
    CanSignal{{36, 16, true, CanKind::number, 50}, "y_m", "m", ""},
    CanSignal{{52, 12, true, CanKind::number, 500}, "yaw_rad", "rad", ""}};
inline constexpr std::array kSetModeSignals{
    kTick, CanSignal{{20, 4, false, CanKind::name, 1}, "mode", "", "", kOperatingModeNames}};
inline constexpr std::array kMapSlotSignals{
    kTick, CanSignal{{20, 8, false, CanKind::count, 1}, "slot", "", "where maps are kept"}};
inline constexpr std::array kStartCalibrationSignals{
    kTick, CanSignal{{20, 4, false, CanKind::count, 1},
                     "procedure",
                     "",
                     "0: all; 15: that is all, check what there is"}};
inline constexpr std::array kTickOnlySignals{kTick};
inline constexpr std::array kReadEventsSignals{
    kTick, CanSignal{{20, 16, false, CanKind::count, 1},
                     "index",
                     "",
                     "of the first event wanted; older than those held: the oldest"}};

inline constexpr CanMessage kPose{"PicoloPose", 0, 1, false, kPoseSignals, "the published pose"};
inline constexpr CanMessage kHealth{"PicoloHealth",
                                    1,
                                    1,
                                    false,
                                    kHealthSignals,
                                    "how far the pose of the same counter may be trusted"};
inline constexpr CanMessage kTwist{"PicoloTwist", 2, 1, false, kTwistSignals, "velocity"};
inline constexpr CanMessage kTime{"PicoloTime", 3, 1, false, kTimeSignals, "instant of the pose"};
inline constexpr CanMessage kMatchSigma{"PicoloMatchSigma",
                                        4,
                                        4,
                                        false,
                                        kSigmaSignals,
                                        "standard deviations of the pose given the map"};
inline constexpr CanMessage kDriftSigma{"PicoloDriftSigma",
                                        5,
                                        4,
                                        false,
                                        kSigmaSignals,
                                        "standard deviations of the map against the start"};
inline constexpr CanMessage kCorrelation{
    "PicoloCorrelation", 6, 4, false, kCorrelationSignals, "correlations of both covariances"};
inline constexpr CanMessage kEvent{
    "PicoloEvent", 7, 0, false, kEventSignals, "one event, at most one a report"};
inline constexpr CanMessage kEventTime{"PicoloEventTime",         8, 0, false, kEventTimeSignals,
                                       "follows each PicoloEvent"};
inline constexpr CanMessage kCounter{
    "PicoloCounter", 9, 4, false, kCounterSignals, "one counter after the other"};
inline constexpr CanMessage kCalibration{"PicoloCalibration",
                                         10,
                                         4,
                                         false,
                                         kCalibrationSignals,
                                         "progress; sent while and after a calibration runs"};
inline constexpr CanMessage kCalibrationValue{
    "PicoloCalibrationValue",
    11,
    4,
    false,
    kCalibrationValueSignals,
    "one result after the other, once a calibration has ended well"};
inline constexpr CanMessage kCalibrationHint{
    "PicoloCalibrationHint",
    13,
    4,
    false,
    kCalibrationHintSignals,
    "what each parameter has, and what to drive next; while a calibration runs"};
inline constexpr CanMessage kReply{
    "PicoloReply", 12, 0, false, kReplySignals, "answers every command, taken or refused"};

inline constexpr CanMessage kSetPose{"PicoloSetPose",
                                     16,
                                     0,
                                     true,
                                     kSetPoseSignals,
                                     "the vehicle stands or drives here; 2 cm and 2 mrad: the next "
                                     "matches find the rest"};
inline constexpr CanMessage kSetMode{
    "PicoloSetMode", 17, 0, true, kSetModeSignals, "what the controller shall do"};
inline constexpr CanMessage kSaveMap{
    "PicoloSaveMap", 18, 0, true, kMapSlotSignals, "keep the map; answered when it is stored"};
inline constexpr CanMessage kLoadMap{
    "PicoloLoadMap", 19, 0, true, kMapSlotSignals, "fetch a kept map; answered when it is in use"};
inline constexpr CanMessage kStartCalibration{
    "PicoloStartCalibration", 20, 0, true, kStartCalibrationSignals, "then drive the figure"};
inline constexpr CanMessage kAbortCalibration{
    "PicoloAbortCalibration", 21, 0, true, kTickOnlySignals, "nothing is changed"};
inline constexpr CanMessage kReadEvents{"PicoloReadEvents",
                                        22,
                                        0,
                                        true,
                                        kReadEventsSignals,
                                        "send the events held from there on once more"};

/// All of them, by offset.
inline constexpr std::array kMessages{&kPose,
                                      &kHealth,
                                      &kTwist,
                                      &kTime,
                                      &kMatchSigma,
                                      &kDriftSigma,
                                      &kCorrelation,
                                      &kEvent,
                                      &kEventTime,
                                      &kCounter,
                                      &kCalibration,
                                      &kCalibrationValue,
                                      &kReply,
                                      &kCalibrationHint,
                                      &kSetPose,
                                      &kSetMode,
                                      &kSaveMap,
                                      &kLoadMap,
                                      &kStartCalibration,
                                      &kAbortCalibration,
                                      &kReadEvents};

/// Signals lie behind the head, inside the frame, and do not overlap.
[[nodiscard]] constexpr bool valid(const CanMessage& message) {
  std::uint64_t used = (std::uint64_t{1} << kCanPayloadBit) - 1;
  for (const CanSignal& signal : message.signals) {
    if (signal.bits == 0 || signal.start_bit + signal.bits > 64 || signal.per_unit < 1) {
      return false;
    }
    const std::uint64_t mask = ((std::uint64_t{1} << signal.bits) - 1) << signal.start_bit;
    if ((used & mask) != 0) { return false; }
    used |= mask;
  }
  const bool in_range = message.is_command ? message.offset >= kCanOwnIds &&
                                                 message.offset < kCanOwnIds + kCanCommandIds
                                           : message.offset < kCanOwnIds;
  return in_range && message.signals.size() <= kMaxCanSignals;
}
[[nodiscard]] constexpr bool valid_table() {
  for (std::size_t i = 0; i < kMessages.size(); ++i) {
    if (!valid(*kMessages[i])) { return false; }
    if (i > 0 && kMessages[i]->offset <= kMessages[i - 1]->offset) { return false; }
  }
  return true;
}
static_assert(valid_table());

}  // namespace can_table

namespace can_layout {

inline constexpr CanLayout kPose = layout_of(can_table::kPose);
inline constexpr CanLayout kHealth = layout_of(can_table::kHealth);
inline constexpr CanLayout kTwist = layout_of(can_table::kTwist);
inline constexpr CanLayout kTime = layout_of(can_table::kTime);
inline constexpr CanLayout kMatchSigma = layout_of(can_table::kMatchSigma);
inline constexpr CanLayout kDriftSigma = layout_of(can_table::kDriftSigma);
inline constexpr CanLayout kCorrelation = layout_of(can_table::kCorrelation);
inline constexpr CanLayout kEvent = layout_of(can_table::kEvent);
inline constexpr CanLayout kEventTime = layout_of(can_table::kEventTime);
inline constexpr CanLayout kCounter = layout_of(can_table::kCounter);
inline constexpr CanLayout kCalibration = layout_of(can_table::kCalibration);
inline constexpr CanLayout kCalibrationValue = layout_of(can_table::kCalibrationValue);
inline constexpr CanLayout kCalibrationHint = layout_of(can_table::kCalibrationHint);
inline constexpr CanLayout kReply = layout_of(can_table::kReply);
inline constexpr CanLayout kSetPose = layout_of(can_table::kSetPose);
inline constexpr CanLayout kSetMode = layout_of(can_table::kSetMode);
inline constexpr CanLayout kSaveMap = layout_of(can_table::kSaveMap);
inline constexpr CanLayout kLoadMap = layout_of(can_table::kLoadMap);
inline constexpr CanLayout kStartCalibration = layout_of(can_table::kStartCalibration);
inline constexpr CanLayout kAbortCalibration = layout_of(can_table::kAbortCalibration);
inline constexpr CanLayout kReadEvents = layout_of(can_table::kReadEvents);

}  // namespace can_layout
}  // namespace picolo::inline v0
