// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A clock that only tasks and the test move, a watchdog that counts, and tasks that take as long
/// as they are told.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "picolo/executive/executive.hpp"

namespace picolo {

struct FakeTime {
  Timestamp time{};
  [[nodiscard]] Timestamp now() const { return time; }
};

/// One cycle a microsecond of fake time.
struct FakeCycles {
  const FakeTime& time;
  [[nodiscard]] std::uint32_t cycles() const {
    return static_cast<std::uint32_t>(time.time.time_since_epoch().count());
  }
};

struct FakeWatchdog {
  std::vector<Timestamp> strokes;
  const FakeTime& time;
  void stroke() { strokes.push_back(time.time); }
};

struct TaskRun {
  std::size_t task;
  std::uint32_t frame;
  Timestamp release;
  Timestamp start;
  std::uint32_t work_bound;
  friend bool operator==(const TaskRun&, const TaskRun&) = default;
};

/// Records every run; `length(task, frame)` is how long it takes, `does_work(task, frame)` whether
/// it passes its checkpoint.
struct FakeTasks {
  FakeTime& time;
  std::function<Duration(std::size_t, std::uint32_t)> length = [](auto, auto) { return 10us; };
  std::function<bool(std::size_t, std::uint32_t)> does_work = [](auto, auto) { return true; };
  std::vector<TaskRun> runs{};

  bool run(std::size_t task, std::uint32_t work_bound, const FrameInfo& frame) {
    runs.push_back({task, frame.number, frame.release, frame.start, work_bound});
    time.time += length(task, frame.number);
    return does_work(task, frame.number);
  }
  [[nodiscard]] std::vector<std::uint32_t> frames_of(std::size_t task) const {
    std::vector<std::uint32_t> frames;
    for (const TaskRun& run : runs) {
      if (run.task == task) { frames.push_back(run.frame); }
    }
    return frames;
  }
};

/// An executive with everything around it, at one microsecond past a round number so that nothing
/// holds by accident.
template <std::size_t Tasks>
struct Rig {
  explicit Rig(const TaskTable<Tasks>& table, const ExecutiveConfig& config = {})
      : executive(config, table, time, cycles, watchdog) {}

  FakeTime time{Timestamp{1s + 1us}};
  FakeCycles cycles{time};
  FakeWatchdog watchdog{{}, time};
  FakeTasks tasks{time};
  Executive<FakeTime, FakeCycles, FakeWatchdog, Tasks> executive;

  /// Sleeps until the next release, unless it has passed already, and runs the frame.
  Status sleep_and_run() {
    time.time = std::max(time.time, executive.next_release());
    return executive.run_frame(tasks);
  }
  void run_frames(int frames) {
    for (int i = 0; i < frames; ++i) { (void)sleep_and_run(); }
  }
};

}  // namespace picolo
