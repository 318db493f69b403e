// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the watchdog's early warning leaves behind for the run after the reset: who is to blame.
#pragma once

#include <cstdint>
#include <type_traits>

#include "picolo/core/result.hpp"
#include "picolo/executive/schedule.hpp"
#include "picolo/localisation/event_ring.hpp"

namespace picolo::inline v0 {

enum class ResetCause : std::uint8_t {
  fault,   ///< a task overran whose policy is `fault`
  stuck,   ///< a task did not return
  starved  ///< no major frame was complete: overruns, slips, or nobody called the cycle
};

struct ResetReport {
  ResetCause cause;
  /// The task that faulted, that did not return, or that overran last; or Schedule::kNoTask.
  std::uint8_t task;
  std::uint32_t frames;    ///< minor frames that were run
  std::uint32_t slipped;   ///< and were not
  std::uint32_t overruns;  ///< of all tasks
  std::uint32_t resets;    ///< by the watchdog since power came on, this one included
};

/// Trivial on purpose, as EventRing is: to lie in memory that start-up code leaves alone.
class LastWords {
 public:
  /// Cost: O(1). Context: the early warning, an NMI as a rule; the cycle may be anywhere.
  void note(const Schedule& schedule, Timestamp now);
  /// Once after start, before the controller's: what the run before left behind, which becomes the
  /// event `watchdog_reset`, too. `not_ready`: it ended otherwise, or there was none.
  [[nodiscard]] Result<ResetReport> take(EventRing& events);

 private:
  [[nodiscard]] std::uint32_t seal() const;

  ResetReport report_;
  std::uint32_t noted_;
  std::uint32_t seal_;  // agrees with the two above unless memory is random
};
static_assert(std::is_trivially_default_constructible_v<LastWords> &&
              std::is_trivially_copyable_v<LastWords>);

}  // namespace picolo::inline v0
