// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The whole robot on real devices: UART, SysTick, watchdog. Words: how many seconds to run (0: for
// ever), after how many milliseconds the clock's 32-bit counter wraps, then `paced` where
// a host plays the world (HostPace), or `hang` to stop the cycle after the first second. Figures at
// the end go to the debugger.

#include <cstring>
#include <new>

#include "platform.hpp"
#include "robot.hpp"

namespace picolo {
namespace {

constexpr Duration kWatchdogPeriod = 200ms;  // two major frames, then as long again

/// Survives a reset.
struct Survivor {
  std::uint32_t mark;
  std::uint32_t barks;  // NMIs of the watchdog
  EventRing events;
};
constexpr std::uint32_t kMark = 0x5EEDB0A7;

[[gnu::section(".noinit")]] Survivor g_survivor;
alignas(64) constinit std::byte g_board[sizeof(mps2::Mps2Board)];
alignas(64) constinit std::byte g_robot[sizeof(FreeRunningRobot)];

std::uint32_t number(std::size_t word) {
  char text[16];
  platform::argument(word, text);
  std::uint32_t value = 0;
  for (const char* at = text; *at >= '0' && *at <= '9'; ++at) {
    value = value * 10 + static_cast<std::uint32_t>(*at - '0');
  }
  return value;
}

bool asked_to(const char* word) {
  char text[8];
  platform::argument(2, text);
  return std::strcmp(text, word) == 0;
}

void tell(const char* name, std::uint64_t value) {
  platform::write(name);
  platform::write(" ");
  platform::write_decimal(value);
  platform::write("\n");
}

void tell_figures(const FreeRunningRobot& robot, const mps2::Mps2Board& board) {
  const FrameCounters& frames = robot.controller().schedule().frame_counters();
  const ControllerCounters& counters = robot.controller().counters();
  tell("frames", frames.frames);
  tell("slipped", frames.slipped);
  tell("late_ends", frames.late_ends);
  tell("worst_lateness_us", static_cast<std::uint64_t>(frames.worst_lateness.count()));
  tell("strokes", frames.strokes);
  const Schedule& schedule = robot.controller().schedule();
  for (std::size_t task = 0; task < schedule.size(); ++task) {
    platform::write("overruns_");
    tell(schedule.entry(task).name, schedule.counters(task).overruns);
  }
  tell("lost_can", board.can.lost());
  tell("lost_lidar", board.lidar.lost());
  tell("lost_imu", board.imu.lost());
  tell("malformed_lines", robot.can().counters().malformed);
  tell("bad_checksums", robot.lidar().counters().bad_checksums);
  tell("readings", counters.readings);
  tell("imu_samples", counters.imu_samples);
  tell("ticks", counters.ticks);
  tell("frames_sent", robot.controller().reporter().sent());
  tell("frames_refused", robot.controller().reporter().refused());
  tell("matches", robot.controller().estimate().matches);
  tell("reason", static_cast<std::uint64_t>(robot.controller().estimate().reason));
  tell("state", static_cast<std::uint64_t>(robot.controller().estimate().state));
}

int run() {
  const bool survived = g_survivor.mark == kMark;
  if (!survived) { g_survivor.barks = 0; }
  g_survivor.mark = kMark;
  if (survived && g_survivor.barks > 0) {
    tell("barks", g_survivor.barks);
    tell("events", g_survivor.events.attach() ? g_survivor.events.total() : 0);
    tell("store_survived", (new (g_board) mps2::Mps2Board({}))->store.survived() ? 1 : 0);
    return 0;
  }
  const std::uint32_t seconds = number(0);
  const std::uint32_t wrap_ticks = number(1) * 1000 * mps2::kTicksPerUs;
  const bool hangs = asked_to("hang");
  const bool paced = asked_to("paced");
  auto& board = *new (g_board) mps2::Mps2Board({.first_count = 0U - wrap_ticks});
  auto& robot = *new (g_robot) FreeRunningRobot(board, g_survivor.events);
  board.start(5ms);
  if (paced) { board.pace.start(); }
  if (!is_ok(robot.start())) { return 1; }
  board.watchdog.start(kWatchdogPeriod);
  robot.run_frame();  // the first is released at once, the others with each tick
  while (seconds == 0 || board.frame_timer.ticks() < seconds * 200) {
    while (!board.frame_timer.take()) {
      if (paced && !board.pace.level(board.bytes_arrived())) {
        platform::pause();
      } else {
        board.frame_timer.rest();
      }
    }
    robot.run_frame();
    while (hangs && board.frame_timer.ticks() > 200) {}
  }
  tell_figures(robot, board);
  return 0;
}

}  // namespace
}  // namespace picolo

/// The watchdog's first word. What is in memory can still be saved; the reset comes by itself.
extern "C" void nmi_handler() {
  picolo::g_survivor.barks = picolo::g_survivor.barks + 1;
  while (true) { __asm__ volatile("" ::: "memory"); }
}

int main() {
  picolo::platform::leave(picolo::run());
}
