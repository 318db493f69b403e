// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The cyclic executive: only a scheduler. It owns no thread, no timer and no task; a port calls
/// `run_frame` when `next_release` has come, from an absolute-time sleep, a hardware timer, or a
/// simulated clock.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/executive/schedule.hpp"
#include "picolo/executive/task.hpp"

namespace picolo::inline v0 {

/// Monotonic time. hal's Clock is one.
template <typename T>
concept TimeSource = requires(T& time) {
  { time.now() } -> std::same_as<Timestamp>;
};

/// A free-running counter for measuring work; wraps at 2^32. hal's CycleCounter is one.
template <typename T>
concept CycleSource = requires(T& counter) {
  { counter.cycles() } -> std::same_as<std::uint32_t>;
};

/// hal's Watchdog is one.
template <typename T>
concept WatchdogLike = requires(T& watchdog) {
  watchdog.stroke();
};

/// Does the work: run(task index, its work bound, the frame). True when the work was done, which
/// passes the checkpoint.
template <typename T>
concept TaskRunner = requires(T& runner, std::size_t task, std::uint32_t work_bound,
                              const FrameInfo& frame) {
  { runner.run(task, work_bound, frame) } -> std::same_as<bool>;
};

/// Is told the length of each run; for statistics that need memory, such as medians.
template <typename T>
concept TaskObserver = requires(T& observer, std::size_t task, std::uint32_t cycles) {
  observer.ran(task, cycles);
};

struct NoTaskObserver {
  void ran(std::size_t /*task*/, std::uint32_t /*cycles*/) {}
};

/// The clock judges (releases, budgets), the cycle counter only measures: with an injected clock
/// every decision repeats, whatever the machine's speed. Context: one, the cycle.
template <TimeSource Time, CycleSource Cycles, WatchdogLike Dog, std::size_t Tasks>
class Executive {
  static_assert(Tasks < Schedule::kNoTask);

 public:
  Executive(const ExecutiveConfig& config, const TaskTable<Tasks>& table, Time& time,
            Cycles& cycles, Dog& watchdog)
      : table_(table),
        schedule_(config, table_, states_),
        time_(time),
        cycles_(cycles),
        watchdog_(watchdog) {}
  Executive(const Executive&) = delete;
  Executive& operator=(const Executive&) = delete;
  ~Executive() = default;

  /// The first frame is released at once. `invalid_argument`: see `valid_table`.
  Status start() { return schedule_.start(time_.now()); }
  [[nodiscard]] Timestamp next_release() const { return schedule_.next_release(); }

  /// Runs the tasks of the frame that is due. `not_ready`: none is due, or not started. Cost: the
  /// tasks' own.
  template <TaskRunner Runner, TaskObserver Observer>
  Status run_frame(Runner& runner, Observer& observer) {
    const Result<FrameInfo> frame = schedule_.begin_frame(time_.now());
    if (!frame) { return frame.status(); }
    for (std::size_t task = 0; task < Tasks; ++task) {
      if (!schedule_.take(task)) { continue; }
      const Timestamp start = time_.now();
      const std::uint32_t first_cycle = cycles_.cycles();
      const bool passed = runner.run(task, table_[task].work_bound, *frame);
      const std::uint32_t spent = cycles_.cycles() - first_cycle;
      schedule_.finish(task, time_.now() - start, spent, passed);
      observer.ran(task, spent);
    }
    if (schedule_.end_frame(time_.now())) { watchdog_.stroke(); }
    return Status::ok;
  }
  template <TaskRunner Runner>
  Status run_frame(Runner& runner) {
    NoTaskObserver nobody;
    return run_frame(runner, nobody);
  }

  [[nodiscard]] const Schedule& schedule() const { return schedule_; }
  /// Spoils every major frame from now on: the watchdog will reset the board.
  void fault() { schedule_.fault(); }

 private:
  TaskTable<Tasks> table_;
  std::array<TaskState, Tasks> states_{};
  Schedule schedule_;
  Time& time_;
  Cycles& cycles_;
  Dog& watchdog_;
};

}  // namespace picolo::inline v0
