// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The whole robot on real devices: UART, SysTick, watchdog, flash. Words: how many seconds to run
// (0: for ever), after how many milliseconds the clock's 32-bit counter wraps, `paced` where a host
// plays the world (HostPace), how many microseconds an erase of the flash takes, `waits` when it
// stops the processor meanwhile, and a file. Figures at the end go to the debugger; given a file,
// the board is then left to its watchdog, and what the flash holds after the reset goes into the
// file.

#include <cstring>
#include <new>

#include "picolo/simulated/trajectory_hash.hpp"
#include "platform.hpp"
#include "robot.hpp"
#include "timed_store.hpp"

namespace picolo {
namespace {

alignas(64) constinit std::byte g_board[sizeof(mps2::Mps2Board)];
alignas(64) constinit std::byte g_robot[sizeof(FreeRunningRobot)];

bool asked_to(std::size_t index, const char* word) {
  char text[8];
  platform::argument(index, text);
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

/// As if it had been in use before: no sector is erased, none holds a record or a map.
void soil(ByteStore& store) {
  const ByteStoreGeometry g = store.geometry();
  constexpr std::array<std::uint8_t, 16> kZeros{};
  for (std::size_t end = g.sector; end <= g.size; end += g.sector) {
    static_cast<void>(store.program(end - g.granule, std::span{kZeros}.first(g.granule)));
  }
}

/// What a save left, as a restart finds it.
int tell_what_is_kept(const ResetReport& reset, mps2::Mps2Board& board, FreeRunningRobot& robot,
                      const char* file) {
  tell_reset(reset, robot.controller().schedule());
  CalibrationStore records{board.store};
  CalibrationRecord record;
  tell("record_status", static_cast<std::uint64_t>(records.load(record)));
  tell("map_status", static_cast<std::uint64_t>(robot.load_map()));
  Hash map;
  add_map(robot.controller().pipeline().localiser().map(), map);
  tell("map_hash", map.value() >> 1);  // a signed number on the host
  const int output = platform::open_output(file);
  std::array<std::uint8_t, 4096> piece{};
  for (std::size_t at = 0; at < board.store.geometry().size; at += piece.size()) {
    if (!is_ok(board.store.read(at, piece)) || !platform::write_file(output, piece)) { return 1; }
  }
  return 0;
}

int run() {
  const Result<ResetReport> reset = last_reset();
  const std::uint32_t seconds = word_as_number(0);
  const std::uint32_t wrap_ticks = word_as_number(1) * 1000 * mps2::kTicksPerUs;
  const bool paced = asked_to(2, "paced");
  char file[128];
  platform::argument(5, file);
  auto& board = *new (g_board) mps2::Mps2Board({.first_count = 0U - wrap_ticks});
  TimedStore flash{board.store, board.clock, Duration{word_as_number(3)}, asked_to(4, "waits")};
  auto& robot =
      *new (g_robot) FreeRunningRobot({.board = board, .lidar = board.lidar, .store = flash});
  if (reset) { return tell_what_is_kept(*reset, board, robot, file); }
  soil(board.store);
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
  tell("erases", flash.erases());
  const TaskCounters& background =
      robot.controller().schedule().counters(static_cast<std::size_t>(ControllerTask::background));
  tell("background_worst_us", background.worst_cycles / mps2::kTicksPerUs);
  while (file[0] != '\0') { board.frame_timer.rest(); }
  return 0;
}

}  // namespace
}  // namespace picolo

int main() {
  picolo::platform::leave(picolo::run());
}
