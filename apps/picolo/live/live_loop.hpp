// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// One drive of a vehicle, cycle by cycle, whoever keeps the time.
#pragma once

#include <functional>

#include "live/drive_journal.hpp"
#include "live/live_vehicle.hpp"
#include "live/recorder.hpp"

namespace picolo::tool {

/// Starts and runs the cycles, writes journal and recording.
class LiveLoop {
 public:
  /// `recorder` may be nullptr. Everything outlives the loop.
  LiveLoop(LiveVehicle& vehicle, LatchedClock& clock, Recorder* recorder)
      : vehicle_(vehicle), clock_(clock), recorder_(recorder) {}

  /// Throws UserError (refused) when the controller does not start.
  void start(Timestamp now);
  /// One cycle at `now`. True when the state changed.
  bool cycle(Timestamp now);
  [[nodiscard]] const DriveJournal& journal() const { return journal_; }
  /// Closes the recording.
  void finish();

 private:
  LiveVehicle& vehicle_;
  LatchedClock& clock_;
  Recorder* recorder_;
  DriveJournal journal_{Timestamp{}};
};

}  // namespace picolo::tool
