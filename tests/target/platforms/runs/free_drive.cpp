// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "free_drive.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <deque>
#include <memory>

#include "picolo/controller/can_codec.hpp"
#include "picolo/simulated/trajectory_hash.hpp"
#include "qemu_board.hpp"
#include "support/slcan_adapter.hpp"

namespace picolo::target {
namespace {

enum Uart : std::size_t { kCan, kLidar, kImu, kPulse };

constexpr std::uint16_t kBase = FramesOutConfig{}.base_id;

class Surroundings {
 public:
  Surroundings(QemuBoard& board, const FreeDrivePlan& plan, FreeDrive& drive)
      : board_(board),
        plan_(plan),
        drive_(drive),
        simulation_(std::make_unique<sim::Simulation>(plan.world)) {}

  void run() {
    constexpr std::array<std::size_t, 2> kHeard{kPulse, kCan};
    std::array<std::uint8_t, 64> pulses{};
    while (board_.wait_for(kHeard)) {
      hear_frames();
      const std::size_t count = board_.receive(kPulse, pulses);
      for (std::size_t i = 0; i < count; ++i) { live_until(pulses[i]); }
    }
  }

 private:
  void live_until(std::uint8_t pulse) {
    milliseconds_ += static_cast<std::uint8_t>(pulse - (milliseconds_ & 0xFF));
    simulation_->advance_to(Timestamp{std::chrono::milliseconds{milliseconds_}});
    judge_what_has_come();
    speak();
    const auto answer = static_cast<std::uint8_t>(sent_ & 0xFFU);
    board_.send(kPulse, {&answer, 1});
  }

  void hear_frames() {
    std::array<std::uint8_t, 1024> bytes{};
    adapter_.take(std::span{bytes}.first(board_.receive(kCan, bytes)));
    for (; !adapter_.frames.empty(); adapter_.frames.pop_front()) {
      (void)simulation_->can().transmit(adapter_.frames.front());
      look_at(adapter_.frames.front());
    }
    drive_.damaged_lines = adapter_.damaged;
  }

  void look_at(const CanFrame& frame) {
    if (const auto pose = decode(can_table::kPose, kBase, frame)) { pose_ = *pose; }
    if (const auto time = decode(can_table::kTime, kBase, frame)) { judge(*time); }
    if (const auto calibration = decode(can_table::kCalibration, kBase, frame)) {
      ++drive_.calibration_frames;
      drive_.calibration_phase = static_cast<CalibrationPhase>(calibration->raw[0]);
    }
    if (const auto reply = decode(can_table::kReply, kBase, frame)) {
      drive_.answers.push_back(static_cast<CommandResult>(reply->raw[2]));
    }
    if (const auto health = decode(can_table::kHealth, kBase, frame)) { ask(*health); }
  }

  void judge(const CanValues& time) {
    if (time.counter != pose_.counter) { return; }
    ++drive_.poses;
    waiting_.push_back({Timestamp{Duration{time.raw[0]}}, pose_});
  }

  /// The board's clock is up to a millisecond ahead of its pulses.
  void judge_what_has_come() {
    for (; !waiting_.empty() && waiting_.front().first <= simulation_->now();
         waiting_.pop_front()) {
      const auto& [stamp, pose] = waiting_.front();
      const Result<sim::Truth> truth = simulation_->truth(stamp);
      if (!truth || stamp < Timestamp{plan_.judged_from}) { continue; }
      const Pose2d at = between(simulation_->config().scene.world_T_start, truth->world_T_base);
      const double error_m = std::hypot(to_value(can_table::kPoseSignals[0], pose.raw[0]) - at.x_m,
                                        to_value(can_table::kPoseSignals[1], pose.raw[1]) - at.y_m);
      drive_.worst_error_m = std::max(drive_.worst_error_m, error_m);
      drive_.driven_m = std::max(drive_.driven_m, std::hypot(at.x_m, at.y_m));
    }
  }

  void ask(const CanValues& health) {
    if (asked_ == plan_.asks.size() ||
        std::chrono::milliseconds{milliseconds_} < plan_.asks[asked_].at) {
      return;
    }
    Command command = plan_.asks[asked_].command;
    command.counter = static_cast<std::uint8_t>(asked_ + 1);
    command.tick = static_cast<std::uint8_t>(health.raw[3]);
    ++asked_;
    say(kCan, test::SlcanAdapter::line_of(encode_command(kBase, command)));
  }

  /// What reached the vehicle's ends of the wires by now.
  void speak() {
    std::string lines = adapter_.answers;
    adapter_.answers.clear();
    while (const Result<CanFrame> frame = simulation_->can().receive()) {
      if (adapter_.open) { lines += test::SlcanAdapter::line_of(*frame); }
    }
    say(kCan, lines);
    pass_on(simulation_->lidar_port(), kLidar);
    pass_on(simulation_->imu_port(), kImu);
  }

  void pass_on(SerialPort& port, Uart uart) {
    std::array<std::uint8_t, 256> bytes{};
    while (const Result<SerialRead> got = port.read(bytes)) {
      send(uart, std::span{bytes}.first(got->size));
    }
  }

  void say(Uart uart, const std::string& text) {
    send(uart, std::vector<std::uint8_t>(text.begin(), text.end()));
  }

  void send(Uart uart, std::span<const std::uint8_t> bytes) {
    board_.send(uart, bytes);
    sent_ += bytes.size();
  }

  QemuBoard& board_;
  const FreeDrivePlan& plan_;
  FreeDrive& drive_;
  std::unique_ptr<sim::Simulation> simulation_;
  test::SlcanAdapter adapter_;
  CanValues pose_{};
  std::deque<std::pair<Timestamp, CanValues>> waiting_;  // poses and their stamps
  std::int64_t milliseconds_ = 0;
  std::size_t asked_ = 0;
  std::size_t sent_ = 0;  // bytes, to all UARTs of the robot
};

}  // namespace

std::vector<Platform> boards_with_devices() {
  std::vector<Platform> boards = platforms_to_judge();
  std::erase_if(boards, [](const Platform& platform) {
    return !std::filesystem::exists(image(platform, "free_running"));
  });
  return boards;
}

FreeDrive drive_freely(const Platform& platform, const FreeDrivePlan& plan) {
  FreeDrive drive;
  QemuBoard board{platform,
                  "free_running",
                  {std::to_string(plan.seconds), std::to_string(plan.wrap_ms), "paced",
                   std::to_string(plan.erase_time.count()), plan.erase_waits ? "waits" : "goes_on",
                   plan.flash_file.string()},
                  "-icount shift=1,sleep=off"};
  if (board.started()) { Surroundings{board, plan, drive}.run(); }
  const Outcome outcome = board.finish();
  if (outcome.status != 0) { drive.trouble = "the image's status is not 0: " + outcome.output; }
  if (board.not_sent() > 0) { drive.trouble += "QEMU did not take all bytes"; }
  drive.figures = figures_in(outcome.output);
  return drive;
}

std::int64_t overruns_in(const Figures& figures) {
  std::int64_t sum = 0;
  for (const auto& [name, value] : figures) { sum += name.starts_with("overruns_") ? value : 0; }
  return sum;
}

std::int64_t bytes_lost(const Figures& figures) {
  return figures.at("lost_can") + figures.at("lost_lidar") + figures.at("lost_imu");
}

FileByteStoreConfig flash_in(const std::filesystem::path& file) {
  return {.geometry = {.size = std::filesystem::file_size(file), .sector = 4096, .granule = 8}};
}

void expect_map_kept(const FreeDrivePlan& plan, const FreeDrive& drive) {
  ASSERT_EQ(drive.figures.at("map_status"), static_cast<int>(Status::ok));
  FileByteStore flash{flash_in(plan.flash_file)};
  ASSERT_EQ(flash.open(plan.flash_file.c_str()), Status::ok);
  MapStore store{flash, {.address = 2 * flash.geometry().sector}};
  const auto owned = std::make_unique<SimulatedController<RoomProfile>>(plan.world);
  SimulatedController<RoomProfile>& robot = *owned;
  ASSERT_EQ(robot.controller().load_map(store), Status::ok);
  Hash map;
  add_map(robot.controller().pipeline().localiser().map(), map);
  EXPECT_EQ(static_cast<std::int64_t>(map.value() >> 1), drive.figures.at("map_hash"));
  ASSERT_EQ(robot.start(), Status::ok);
  for (int frame = 0; frame < 5 * 200; ++frame) { ASSERT_EQ(robot.run_frame(), Status::ok); }
  const PoseEstimate& pose = robot.controller().estimate();
  EXPECT_EQ(pose.state, HealthState::tracking);
  const Result<Pose2d> truth = robot.true_map_T_base(pose.stamp);
  ASSERT_TRUE(truth);
  EXPECT_LT(std::hypot(pose.map_T_base.x_m - truth->x_m, pose.map_T_base.y_m - truth->y_m), 0.1);
}

}  // namespace picolo::target
