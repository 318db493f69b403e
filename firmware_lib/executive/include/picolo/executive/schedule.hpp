// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The logic of the cyclic executive, without a clock: it is told the time and says what is due.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/executive/checkpoints.hpp"
#include "picolo/executive/task.hpp"

namespace picolo::inline v0 {

/// One minor frame as its tasks see it.
struct FrameInfo {
  Timestamp release{};  ///< when it should have started; always a multiple of the minor frame after
                        ///< the start
  Timestamp start{};    ///< when it did; the one time that all tasks of the frame use
  /// Counts minor frames since the start, slipped ones included, modulo 2^32.
  std::uint32_t number = 0;
};

/// What `Schedule` keeps for one task.
struct TaskState {
  TaskCounters counters{};
  bool pending = false;  // released in a slipped frame and not run yet
  bool skip_next = false;
};

/// Strict period: frame k is released at start + k * minor frame, however long the frames before
/// took. A cycle late by n > 1 whole frames runs the newest overdue frame only and counts n - 1 as
/// slipped; a task released in a slipped frame runs once in the frame that is run, its further lost
/// releases are its slips. So nobody catches up by more than one frame. Cost: every call O(tasks)
/// at most. Context: cycle only.
class Schedule {
 public:
  /// `table` and `states` have equal size and outlive the schedule.
  Schedule(const ExecutiveConfig& config, std::span<const TaskEntry> table,
           std::span<TaskState> states);

  /// First release at `first`. `invalid_argument`: the table is not valid for the configuration;
  /// nothing will run.
  Status start(Timestamp first);
  [[nodiscard]] Timestamp next_release() const { return next_release_; }

  /// Opens the frame that is due. `not_ready`: none is, or not started.
  Result<FrameInfo> begin_frame(Timestamp now);
  /// True when the task runs in the open frame. To be asked once a task and frame, in the order of
  /// the table.
  [[nodiscard]] bool take(std::size_t task);
  /// Accounts for a run. `passed`: the task did its work; false spoils the major frame.
  void finish(std::size_t task, Duration time, std::uint32_t cycles, bool passed);
  /// Closes the frame. True when it ended a complete major frame: stroke the watchdog.
  [[nodiscard]] bool end_frame(Timestamp now);

  /// Spoils every major frame from now on.
  void fault() { faulted_ = true; }
  [[nodiscard]] bool faulted() const { return faulted_; }
  [[nodiscard]] std::size_t size() const { return table_.size(); }
  [[nodiscard]] const TaskEntry& entry(std::size_t task) const { return table_[task]; }
  [[nodiscard]] const TaskCounters& counters(std::size_t task) const {
    return states_[task].counters;
  }
  [[nodiscard]] const FrameCounters& frame_counters() const { return frames_; }
  /// Overruns of all tasks together.
  [[nodiscard]] std::uint32_t overruns() const { return overruns_; }

  /// No task; no table is that long.
  static constexpr std::uint8_t kNoTask = 0xFF;
  /// The task that keeps the open frame from ending though the next one is due, or kNoTask.
  /// Context: any; the watchdog's early warning asks it of a cycle that hangs.
  [[nodiscard]] std::uint8_t stuck_in(Timestamp now) const {
    return now - next_release_ >= config_.minor_frame ? running_ : kNoTask;
  }
  /// The task of the newest overrun, after a fault by policy the one that faulted; or kNoTask.
  [[nodiscard]] std::uint8_t overran() const { return overran_; }

 private:
  void slip(std::int64_t frames);
  void begin_round();

  ExecutiveConfig config_;
  std::span<const TaskEntry> table_;
  std::span<TaskState> states_;
  CheckpointMonitor monitor_{};
  FrameCounters frames_{};
  Timestamp next_release_{};
  std::uint32_t number_ = 0;
  std::uint32_t position_ = 0;  // of the open or next frame in its major frame
  std::uint32_t overruns_ = 0;
  std::uint8_t running_ = kNoTask;  // between `take` and `finish`
  std::uint8_t overran_ = kNoTask;
  bool started_ = false;
  bool faulted_ = false;
};

}  // namespace picolo::inline v0
