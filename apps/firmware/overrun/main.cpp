// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The robot with a lidar whose port holds the cycle up. Words: what an overrun of the task `serial`
// means (carry_on, skip_next, fault), in how many frames from the fiftieth on the port spins, and
// for how many microseconds each time (0: it never returns). Figures of 240 frames go to the
// debugger, or, after a reset by the watchdog, what the run before left behind and figures of 60.

#include <cstring>
#include <new>

#include "platform.hpp"
#include "robot.hpp"

namespace picolo {
namespace {

constexpr std::uint32_t kFirstSpin = 50;
constexpr std::uint32_t kTicks = 240;
constexpr std::uint32_t kTicksAfterReset = 60;

alignas(64) constinit std::byte g_board[sizeof(mps2::Mps2Board)];
alignas(64) constinit std::byte g_robot[sizeof(FreeRunningRobot)];
class SpinningPort final : public SerialPort {
 public:
  SpinningPort(SerialPort& port, Clock& clock) : port_(port), clock_(clock) {}

  /// The next read takes so long; 0: for ever.
  void spin(Duration time) {
    time_ = time;
    spins_ = true;
  }
  [[nodiscard]] bool spins() const { return spins_; }
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override {
    if (spins_) {
      spins_ = false;
      for (const Timestamp start = clock_.now();
           time_ == Duration{0} || clock_.now() - start < time_;) {}
    }
    return port_.read(buffer);
  }
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override {
    return port_.write(bytes);
  }
  [[nodiscard]] std::uint32_t baud() const override { return port_.baud(); }
  [[nodiscard]] std::uint32_t lost() const override { return port_.lost(); }

 private:
  SerialPort& port_;
  Clock& clock_;
  Duration time_{};
  bool spins_ = false;
};

OverrunPolicy asked_policy() {
  char text[16];
  platform::argument(0, text);
  if (std::strcmp(text, "fault") == 0) { return OverrunPolicy::fault; }
  return std::strcmp(text, "skip_next") == 0 ? OverrunPolicy::skip_next : OverrunPolicy::carry_on;
}

/// How often it is in the ring, and what its last argument was.
void tell_events(EventCode code, const char* count_name, const char* argument_name) {
  std::uint32_t count = 0;
  std::int32_t argument = 0;
  for (std::size_t i = 0; i < events().size(); ++i) {
    const Event& event = events()[i];
    if (event.code != code) { continue; }
    ++count;
    argument = event.argument;
  }
  tell(count_name, count);
  tell(argument_name, static_cast<std::uint32_t>(argument));
}

int run() {
  const Result<ResetReport> reset = last_reset();
  auto& board = *new (g_board) mps2::Mps2Board({});
  SpinningPort lidar{board.lidar, board.clock};
  auto& robot = *new (g_robot) FreeRunningRobot({.board = board,
                                                 .lidar = lidar,
                                                 .store = board.store,
                                                 .policies = {.serial = asked_policy()}});
  const Schedule& schedule = robot.controller().schedule();
  std::uint32_t spins = reset ? 0 : word_as_number(1);
  const Duration time{word_as_number(2)};
  board.start(5ms);
  if (!is_ok(robot.start())) { return 1; }
  while (board.frame_timer.ticks() < (reset ? kTicksAfterReset : kTicks)) {
    // Without another interrupt beside the tick QEMU sleeps through every second one.
    while (!board.frame_timer.take()) {}
    if (spins > 0 && !lidar.spins() && board.frame_timer.ticks() >= kFirstSpin) {
      --spins;
      lidar.spin(time);
    }
    robot.run_frames();
  }
  if (reset) { tell_reset(*reset, schedule); }
  tell("store_survived", board.store.survived() ? 1 : 0);
  tell_cycle(schedule);
  const TaskCounters& serial = schedule.counters(static_cast<std::size_t>(ControllerTask::serial));
  tell("serial_runs", serial.runs);
  tell("serial_slips", serial.slips);
  tell("serial_skipped", serial.skipped);
  tell("serial_worst_us", serial.worst_cycles / mps2::kTicksPerUs);
  tell_events(EventCode::overrun, "overrun_events", "overrun_task");
  tell_events(EventCode::watchdog_reset, "reset_events", "reset_event_task");
  tell("faulted", schedule.faulted() ? 1 : 0);
  tell("state", static_cast<std::uint64_t>(robot.controller().estimate().state));
  tell("reason", static_cast<std::uint64_t>(robot.controller().estimate().reason));
  return 0;
}

}  // namespace
}  // namespace picolo

int main() {
  picolo::platform::leave(picolo::run());
}
