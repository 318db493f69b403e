// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Commands as the controller meets them: on the bus, among other frames.

#include <gtest/gtest.h>

#include <optional>

#include "picolo/controller/stored_maps.hpp"
#include "rig.hpp"

namespace picolo {
namespace {

using test::FakeImu;
using Rig = test::Rig<FakeImu>;
constexpr std::uint16_t kBase = 0x110;

Command command(CommandKind kind, std::uint8_t counter, Timestamp now) {
  return {.kind = kind, .counter = counter, .tick = can_tick(now)};
}

/// The last reply among the frames sent.
std::optional<CanValues> last_reply(Rig& rig) {
  std::optional<CanValues> reply;
  for (const CanFrame& frame : rig.can.take_sent()) {
    const auto values = decode(can_table::kReply, kBase, frame);
    if (values) { reply = *values; }
  }
  return reply;
}

CommandResult result_of(Rig& rig, const Command& sent) {
  rig.can.arrives(encode_command(kBase, sent));
  rig.run_frame();
  const auto reply = last_reply(rig);
  EXPECT_TRUE(reply);
  if (!reply) { return CommandResult::failed; }
  EXPECT_EQ(reply->raw[0], static_cast<int>(sent.kind));
  EXPECT_EQ(reply->raw[1], sent.counter);
  return static_cast<CommandResult>(reply->raw[2]);
}

TEST(Commands, SetPoseMovesThePublishedPoseAndTrustBeginsAnew) {
  Rig rig;
  rig.run_frame();
  Command set = command(CommandKind::set_pose, 3, rig.clock.time);
  set.map_T_base = {12.5, -3.24, 1.5};
  EXPECT_EQ(result_of(rig, set), CommandResult::done);
  const PoseEstimate& estimate = rig.controller.estimate();
  EXPECT_NEAR(estimate.map_T_base.x_m, 12.5, 1e-9);
  EXPECT_NEAR(estimate.map_T_base.y_m, -3.24, 1e-9);
  EXPECT_NEAR(estimate.map_T_base.theta_rad, 1.5, 1e-9);
  EXPECT_EQ(estimate.state, HealthState::initialising);
  EXPECT_GE(estimate.match_covariance(0, 0), 0.0099F) << "a pose that is set is not exact";
  EXPECT_EQ(rig.controller.commands().counters().accepted, 1U);
  EXPECT_EQ(rig.events[rig.events.size() - 2].code, EventCode::pose_set);
  EXPECT_EQ(estimate.reason, HealthReason::unproven) << "what is seen must fit first";
}

TEST(Commands, SetPoseWithAValueThatIsNotAvailableIsRefused) {
  Rig rig;
  rig.run_frame();
  Command set = command(CommandKind::set_pose, 3, rig.clock.time);
  set.map_T_base = {5000.0, 0.0, 0.0};
  EXPECT_EQ(result_of(rig, set), CommandResult::invalid_argument);
  EXPECT_EQ(rig.controller.estimate().map_T_base.x_m, 0.0);
  EXPECT_EQ(rig.controller.commands().counters().refused, 1U);
}

TEST(Commands, RepeatedStaleAndCorruptOnesAreCountedAnsweredAndDoNothing) {
  Rig rig;
  rig.run_frame();
  Command set = command(CommandKind::set_pose, 3, rig.clock.time);
  set.map_T_base.x_m = 1.0;
  EXPECT_EQ(result_of(rig, set), CommandResult::done);
  set.map_T_base.x_m = 2.0;
  EXPECT_EQ(result_of(rig, set), CommandResult::repeated);
  set.counter = 2;
  EXPECT_EQ(result_of(rig, set), CommandResult::stale) << "behind the last one";
  for (int i = 0; i < 400; ++i) { rig.run_frame(); }
  set.counter = 4;
  EXPECT_EQ(result_of(rig, set), CommandResult::stale) << "recorded two seconds ago";
  CanFrame forged = encode_command(kBase, command(CommandKind::set_pose, 5, rig.clock.time));
  forged.data[4] ^= 0x10;
  rig.can.arrives(forged);
  rig.run_frame();
  const auto reply = last_reply(rig);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->raw[2], static_cast<int>(CommandResult::corrupt));
  EXPECT_EQ(reply->raw[4], 1) << "accepted";
  EXPECT_EQ(reply->raw[5], 4) << "refused";
  const CommandCounters& counters = rig.controller.commands().counters();
  EXPECT_EQ(counters.accepted, 1U);
  EXPECT_EQ(counters.repeated, 1U);
  EXPECT_EQ(counters.stale, 2U);
  EXPECT_EQ(counters.corrupt, 1U);
  EXPECT_NEAR(rig.controller.estimate().map_T_base.x_m, 1.0, 1e-9);
}

TEST(Commands, ASenderGoneWildDoesNotFillTheBus) {
  Rig rig;
  for (int i = 0; i < 4; ++i) { rig.run_frame(); }
  static_cast<void>(rig.can.take_sent());
  CanFrame forged = encode_command(kBase, command(CommandKind::set_mode, 5, rig.clock.time));
  forged.data[0] ^= 0xFF;
  for (int i = 0; i < 32; ++i) { rig.can.arrives(forged); }
  rig.run_frame();
  int replies = 0;
  for (const CanFrame& frame : rig.can.take_sent()) { replies += frame.id == kBase + 12 ? 1 : 0; }
  EXPECT_EQ(replies, 1);
  EXPECT_EQ(rig.controller.commands().counters().corrupt, 32U);
}

TEST(Commands, FramesThatPretendToBeOursAreCountedAndTold) {
  Rig rig;
  rig.run_frame();
  FramesOut somebody{kBase};
  rig.can.arrives(somebody.pose({}));
  rig.run_frame();
  EXPECT_EQ(rig.controller.commands().impersonated(), 1U);
  EXPECT_EQ(rig.controller.counters().foreign_frames, 0U);
  EXPECT_EQ(rig.events[rig.events.size() - 1].code, EventCode::impersonated);
}

TEST(Commands, ModeIsSetAndTold) {
  Rig rig;
  rig.run_frame();
  Command set = command(CommandKind::set_mode, 0, rig.clock.time);
  set.detail = 1;
  EXPECT_EQ(result_of(rig, set), CommandResult::done);
  EXPECT_EQ(rig.controller.commands().mode(), OperatingMode::localising);
  set.counter = 1;
  set.detail = 2;
  EXPECT_EQ(result_of(rig, set), CommandResult::invalid_argument);
}

TEST(Commands, WithoutServicesMapsAndCalibrationAreUnsupported) {
  Rig rig;
  rig.run_frame();
  for (const CommandKind kind : {CommandKind::save_map, CommandKind::load_map,
                                 CommandKind::start_calibration, CommandKind::abort_calibration}) {
    EXPECT_EQ(result_of(rig, command(kind, 1, rig.clock.time)), CommandResult::unsupported);
  }
}

TEST(Commands, EventsAreSentOnceMoreFromTheIndexAskedFor) {
  Rig rig;
  for (int i = 0; i < 100; ++i) { rig.run_frame(); }
  static_cast<void>(rig.can.take_sent());
  const std::uint32_t held = rig.events.total();
  Command read = command(CommandKind::read_events, 1, rig.clock.time);
  read.index = 0;
  rig.can.arrives(encode_command(kBase, read));
  for (std::uint32_t i = 0; i <= 5 * held; ++i) { rig.run_frame(); }
  std::vector<std::int64_t> told;
  for (const CanFrame& frame : rig.can.take_sent()) {
    const auto values = decode(can_table::kEvent, kBase, frame);
    if (values) { told.push_back(values->raw[0]); }
  }
  ASSERT_GE(held, 2U);
  ASSERT_GE(told.size(), held);
  for (std::size_t i = 0; i < held; ++i) { EXPECT_EQ(told[i], static_cast<std::int64_t>(i)); }
}

struct FakeMaps final : MapService {
  std::vector<std::string> calls;
  int steps = 2;
  Status begin_save(std::uint8_t slot, LocaliserCore& /*localiser*/) override {
    calls.push_back("save " + std::to_string(slot));
    return slot == 7 ? Status::invalid_argument : Status::ok;
  }
  Status begin_load(std::uint8_t slot, LocaliserCore& /*localiser*/) override {
    calls.push_back("load " + std::to_string(slot));
    return Status::ok;
  }
  Status step(LocaliserCore& /*localiser*/) override {
    calls.push_back("step");
    return --steps > 0 ? Status::not_ready : Status::ok;
  }
};

TEST(Commands, MapsAreKeptInSlicesAndAnsweredTwice) {
  FakeMaps maps;
  Rig rig{{}, {.maps = &maps}};
  rig.run_frame();
  Command save = command(CommandKind::save_map, 1, rig.clock.time);
  save.detail = 3;
  EXPECT_EQ(result_of(rig, save), CommandResult::started);
  save.counter = 2;
  EXPECT_EQ(result_of(rig, save), CommandResult::busy);
  rig.run_frame();
  const auto end = last_reply(rig);
  ASSERT_TRUE(end);
  EXPECT_EQ(end->raw[2], static_cast<int>(CommandResult::done));
  EXPECT_EQ(end->raw[3], 3) << "the slot";
  EXPECT_EQ(maps.calls, (std::vector<std::string>{"save 3", "step", "step"}));

  Command wrong = command(CommandKind::save_map, 3, rig.clock.time);
  wrong.detail = 7;
  EXPECT_EQ(result_of(rig, wrong), CommandResult::invalid_argument) << "the second answer";
  maps.steps = 1;
  EXPECT_EQ(result_of(rig, command(CommandKind::load_map, 1, rig.clock.time)),
            CommandResult::started);
  rig.run_frame();
  EXPECT_EQ(rig.controller.commands().mode(), OperatingMode::localising) << "the map is kept as is";
}

struct FakeCalibration final : CalibrationService {
  CalibrationProgress state{};
  int heard = 0;
  Status start(std::uint8_t procedure, Timestamp /*now*/) override {
    if (procedure > 2) { return Status::invalid_argument; }
    if (state.phase == CalibrationPhase::collecting) { return Status::not_ready; }
    state = {.phase = CalibrationPhase::collecting, .procedure = procedure, .percent = 40};
    return Status::ok;
  }
  Status cancel(Timestamp /*now*/) override {
    state.phase = CalibrationPhase::aborted;
    return Status::ok;
  }
  void add(const WheelTicks& /*ticks*/) override { ++heard; }
  void add(const ImuSample& /*sample*/) override { ++heard; }
  void add(const UndistortedSweep& /*sweep*/) override { ++heard; }
  void step(Timestamp /*now*/) override {}
  [[nodiscard]] CalibrationProgress progress() const override { return state; }
  [[nodiscard]] CalibrationHint hint() const override {
    return {.advice = DriveAdvice::turn_left, .wheels = 12, .gyro = CalibrationHint::kNoPercent};
  }
  [[nodiscard]] std::size_t value_count() const override { return 1; }
  [[nodiscard]] CalibrationValue value(std::size_t /*index*/) const override {
    return {Parameter::track_width, {0.503, 0.0004}};
  }
};

TEST(Commands, CalibrationIsStartedToldAndAborted) {
  FakeCalibration calibration;
  Rig rig{{}, {.calibration = &calibration}};
  rig.run_frame();
  Command start = command(CommandKind::start_calibration, 1, rig.clock.time);
  start.detail = 2;
  EXPECT_EQ(result_of(rig, start), CommandResult::done);
  start.counter = 2;
  EXPECT_EQ(result_of(rig, start), CommandResult::busy);
  rig.can.arrives(test::can_frame(rig.clock.time, 0x181, {1}));
  rig.imu.waiting.push_back({.stamp = rig.clock.time});
  for (int i = 0; i < 20; ++i) { rig.run_frame(); }
  EXPECT_EQ(calibration.heard, 2);
  int told = 0;
  for (const CanFrame& frame : rig.can.take_sent()) {
    const auto progress = decode(can_table::kCalibration, kBase, frame);
    const auto value = decode(can_table::kCalibrationValue, kBase, frame);
    if (progress) {
      ++told;
      EXPECT_EQ(progress->raw[0], static_cast<int>(CalibrationPhase::collecting));
      EXPECT_EQ(progress->raw[1], 2);
      EXPECT_EQ(progress->raw[2], 40);
    }
    const auto hint = decode(can_table::kCalibrationHint, kBase, frame);
    if (hint) {
      EXPECT_EQ(hint->raw[0], static_cast<int>(DriveAdvice::turn_left));
      EXPECT_EQ(hint->raw[1], 12);
      EXPECT_EQ(hint->raw[6], 127);
    }
    if (value) {
      EXPECT_EQ(value->raw[0], static_cast<int>(Parameter::track_width));
      EXPECT_EQ(value->raw[1], 503'000);
      EXPECT_EQ(value->raw[2], 400);
    }
  }
  EXPECT_EQ(told, 1);
  EXPECT_EQ(result_of(rig, command(CommandKind::abort_calibration, 1, rig.clock.time)),
            CommandResult::done);
  EXPECT_EQ(calibration.state.phase, CalibrationPhase::aborted);
}

}  // namespace
}  // namespace picolo
