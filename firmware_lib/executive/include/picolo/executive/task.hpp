// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The static task table of the cyclic executive: who runs when, with how much work, and what an
/// overrun means.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/time.hpp"

namespace picolo::inline v0 {

/// What happens when a task ran for longer than its budget; every overrun is counted whatever the
/// policy.
enum class OverrunPolicy : std::uint8_t {
  carry_on,   ///< nothing else
  skip_next,  ///< the task's next release is left out, which gives the others their time back
  fault,      ///< the executive is faulted: tasks go on, so that the fault can be told, but the
              ///< watchdog starves
};

/// One line of the task table. Tasks of one frame run in the order of the table.
struct TaskEntry {
  const char* name = "";            ///< unique; for counters and logs
  std::uint16_t period_frames = 1;  ///< in minor frames; divides the major frame
  std::uint16_t offset_frames = 0;  ///< first release within the period; less than the period
  std::uint32_t work_bound = 1;  ///< handed to the task at each release; the unit is the task's own
  Duration budget{1000};         ///< a run longer than this is an overrun
  OverrunPolicy policy = OverrunPolicy::carry_on;
  /// Never has work in a frame in which the entry before it had: they share the frame's time.
  bool alternative = false;

  [[nodiscard]] constexpr bool due(std::uint32_t frame) const {
    return frame % period_frames == offset_frames;
  }
};

template <std::size_t Tasks>
using TaskTable = std::array<TaskEntry, Tasks>;

struct ExecutiveConfig {
  Duration minor_frame = 5ms;    ///< distance of two releases of the cycle
  Duration major_frame = 100ms;  ///< after which the pattern of tasks repeats; the watchdog's beat

  /// Minor frames in one major frame.
  [[nodiscard]] constexpr std::uint32_t frames() const {
    return static_cast<std::uint32_t>(major_frame.count() / minor_frame.count());
  }
  [[nodiscard]] constexpr bool valid() const {
    return minor_frame.count() > 0 && major_frame >= minor_frame &&
           major_frame <= Duration{3'600'000'000} && major_frame.count() % minor_frame.count() == 0;
  }
};

/// Sum of the budgets of the fullest minor frame; of alternatives, the longest counts.
/// Precondition: `config` and the entries are valid.
[[nodiscard]] constexpr Duration worst_frame_budget(const ExecutiveConfig& config,
                                                    std::span<const TaskEntry> table) {
  Duration worst{0};
  for (std::uint32_t frame = 0; frame < config.frames(); ++frame) {
    Duration sum{0};
    Duration shared{0};
    for (const TaskEntry& task : table) {
      if (!task.alternative) { shared = Duration{0}; }
      if (!task.due(frame) || task.budget <= shared) { continue; }
      sum += task.budget - shared;
      shared = task.budget;
    }
    worst = sum > worst ? sum : worst;
  }
  return worst;
}

/// Every period divides the major frame, offsets lie within their period, budgets are positive, and
/// the fullest minor frame fits: a table that cannot be kept does not compile when checked by
/// `static_assert`.
[[nodiscard]] constexpr bool valid_table(const ExecutiveConfig& config,
                                         std::span<const TaskEntry> table) {
  if (!config.valid() || table.empty()) { return false; }
  for (const TaskEntry& task : table) {
    if (task.name == nullptr || task.period_frames == 0 ||
        config.frames() % task.period_frames != 0 || task.offset_frames >= task.period_frames ||
        task.budget <= Duration{0}) {
      return false;
    }
  }
  return worst_frame_budget(config, table) <= config.minor_frame;
}

/// What the executive knows about one task. Never reset by the library; all counts are modulo 2^32.
struct TaskCounters {
  std::uint32_t runs = 0;
  std::uint32_t overruns = 0;  ///< runs longer than the budget, by the clock
  std::uint32_t slips = 0;     ///< releases lost because the cycle was late by more than one frame
  std::uint32_t skipped = 0;   ///< releases left out by OverrunPolicy::skip_next
  std::uint32_t unfinished = 0;   ///< runs that did not pass their checkpoint
  std::uint32_t last_cycles = 0;  ///< length of the last run, by the cycle counter
  std::uint32_t worst_cycles = 0;
};

/// The same for the cycle as a whole.
struct FrameCounters {
  std::uint32_t frames = 0;        ///< minor frames run
  std::uint32_t slipped = 0;       ///< minor frames that were never run
  std::uint32_t late_ends = 0;     ///< minor frames that ended after the next release
  std::uint32_t major_frames = 0;  ///< major frames ended
  std::uint32_t strokes = 0;       ///< ... and found complete: the watchdog was stroked
  Duration worst_lateness{0};      ///< of a frame's start against its release
};

}  // namespace picolo::inline v0
