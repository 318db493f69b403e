// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The whole robot on real devices: UART, SysTick, watchdog. Words: how many seconds to run (0: for
// ever), after how many milliseconds the clock's 32-bit counter wraps, then `paced` where a host
// plays the world (HostPace). Figures at the end go to the debugger.

#include <cstring>
#include <new>

#include "platform.hpp"
#include "robot.hpp"

namespace picolo {
namespace {

[[gnu::section(".noinit")]] EventRing g_events;
alignas(64) constinit std::byte g_board[sizeof(mps2::Mps2Board)];
alignas(64) constinit std::byte g_robot[sizeof(FreeRunningRobot)];

bool asked_to(const char* word) {
  char text[8];
  platform::argument(2, text);
  return std::strcmp(text, word) == 0;
}

void tell_figures(const FreeRunningRobot& robot, const mps2::Mps2Board& board) {
  const ControllerCounters& counters = robot.controller().counters();
  tell_cycle(robot.controller().schedule());
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
  const std::uint32_t seconds = word_as_number(0);
  const std::uint32_t wrap_ticks = word_as_number(1) * 1000 * mps2::kTicksPerUs;
  const bool paced = asked_to("paced");
  auto& board = *new (g_board) mps2::Mps2Board({.first_count = 0U - wrap_ticks});
  auto& robot = *new (g_robot) FreeRunningRobot(
      {.board = board, .lidar = board.lidar, .store = board.store}, g_events);
  board.start(5ms);
  if (paced) { board.pace.start(); }
  if (!is_ok(robot.start())) { return 1; }
  while (seconds == 0 || board.frame_timer.ticks() < seconds * 200) {
    while (!board.frame_timer.take()) {
      if (paced && !board.pace.level(board.bytes_arrived())) {
        platform::pause();
      } else {
        board.frame_timer.rest();
      }
    }
    robot.run_frames();
  }
  tell_figures(robot, board);
  return 0;
}

}  // namespace
}  // namespace picolo

int main() {
  picolo::platform::leave(picolo::run());
}
