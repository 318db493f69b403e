// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "robot.hpp"

#include "picolo/simulated/simulated_controller.hpp"
#include "platform.hpp"

namespace picolo {
namespace {

/// Survives a reset.
struct Survivor {
  EventRing events;
  LastWords words;
};
[[gnu::section(".noinit")]] Survivor g_survivor;
// Of the robot that runs; the watchdog is started after they are set.
constinit const Schedule* g_schedule = nullptr;
constinit Clock* g_clock = nullptr;

/// What was calibrated on this board replaces what was configured.
ControllerConfig stored_config(CalibrationStore& records, const TaskPolicies& policies) {
  ControllerConfig config = simulated_vehicle_config();
  // For 500 million instructions a second, software doubles of the Cortex-M4F included. The
  // calibration takes its copy of a sweep while that is undistorted, and works in the background;
  // the map's window moves in one piece.
  config.work.max_returns = 256;
  config.work.max_point_iterations = 1800;
  config.budgets = {.can = Duration{100},
                    .serial = Duration{200},
                    .odometry = Duration{200},
                    .undistort = Duration{850},
                    .match = Duration{1100},
                    .map = Duration{1500},
                    .background = Duration{800},
                    .report = Duration{250}};
  config.policies = policies;
  CalibrationRecord record;
  if (is_ok(records.load(record))) { apply(record, config); }
  return config;
}

/// A tick comes at most so long before the release that it is meant for.
constexpr Duration kTickLead = 1ms;

}  // namespace

FreeRunningRobot::FreeRunningRobot(const RobotWiring& wiring)
    : board_(wiring.board),
      records_(wiring.store),
      stored_map_(wiring.store, {.address = kMapAddress}),
      maps_(wiring.store, {.address = kMapAddress}),
      config_(stored_config(records_, wiring.policies)),
      can_(board_.can),
      wheels_(can_, simulated_wheels_config()),
      lidar_(wiring.lidar),
      imu_(board_.imu),
      calibration_(onboard_calibration(config_), &records_),
      controller_({can_, board_.clock, board_.cycles, board_.watchdog}, wheels_, lidar_, imu_,
                  g_survivor.events, config_,
                  {.maps = &maps_, .calibration = &calibration_.core()}) {}

Status FreeRunningRobot::start() {
  const Status status = controller_.start();
  if (!is_ok(status)) { return status; }
  g_schedule = &controller_.schedule();
  g_clock = &board_.clock;
  board_.watchdog.start(kWatchdogPeriod);
  return controller_.run_frame();
}

void FreeRunningRobot::run_frames() {
  do {
    while (controller_.run_frame() == Status::not_ready) {}
  } while (controller_.next_frame() - board_.clock.now() < kTickLead);
  // Ticks that came meanwhile were meant for frames that have been run.
  static_cast<void>(board_.frame_timer.take());
}

Result<ResetReport> last_reset() {
  return g_survivor.words.take(g_survivor.events);
}

const EventRing& events() {
  return g_survivor.events;
}

std::uint32_t word_as_number(std::size_t index) {
  char text[16];
  platform::argument(index, text);
  std::uint32_t value = 0;
  for (const char* at = text; *at >= '0' && *at <= '9'; ++at) {
    value = value * 10 + static_cast<std::uint32_t>(*at - '0');
  }
  return value;
}

void tell(const char* name, std::uint64_t value) {
  platform::write(name);
  platform::write(" ");
  platform::write_decimal(value);
  platform::write("\n");
}

void tell_reset(const ResetReport& report, const Schedule& schedule) {
  constexpr const char* kCauses[] = {"fault", "stuck", "starved"};
  platform::write("reset by watchdog, task ");
  platform::write(report.task < schedule.size() ? schedule.entry(report.task).name : "none");
  platform::write(", cause ");
  platform::write(kCauses[static_cast<std::size_t>(report.cause)]);
  platform::write("\n");
  tell("reset_task", report.task);
  tell("reset_cause", static_cast<std::uint64_t>(report.cause));
  tell("reset_frames", report.frames);
  tell("reset_slipped", report.slipped);
  tell("reset_overruns", report.overruns);
  tell("resets", report.resets);
}

void tell_cycle(const Schedule& schedule) {
  const FrameCounters& frames = schedule.frame_counters();
  tell("frames", frames.frames);
  tell("slipped", frames.slipped);
  tell("late_ends", frames.late_ends);
  tell("worst_lateness_us", static_cast<std::uint64_t>(frames.worst_lateness.count()));
  tell("major_frames", frames.major_frames);
  tell("strokes", frames.strokes);
  for (std::size_t task = 0; task < schedule.size(); ++task) {
    platform::write("overruns_");
    tell(schedule.entry(task).name, schedule.counters(task).overruns);
  }
}

}  // namespace picolo

/// The watchdog's first word. The reset comes by itself.
extern "C" void nmi_handler() {
  picolo::g_survivor.words.note(*picolo::g_schedule, picolo::g_clock->now());
  while (true) { __asm__ volatile("wfi" ::: "memory"); }
}
