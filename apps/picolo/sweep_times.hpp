// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// How long the cycle works on a sweep.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/controller/controller_config.hpp"
#include "picolo/controller/pipeline.hpp"

namespace picolo::tool {

/// Adds up what the tasks that work on sweeps take; runs that found nothing to do do not count.
class SweepTimes {
 public:
  explicit SweepTimes(const Pipeline& pipeline) : pipeline_{pipeline} {}

  void ran(std::size_t task, std::uint32_t cycles) {
    const bool busy = was_busy_ || pipeline_.stage() != PipelineStage::waiting;
    was_busy_ = pipeline_.stage() != PipelineStage::waiting;
    if (!busy) { return; }
    const double spent_us = 1e-3 * cycles;
    switch (static_cast<ControllerTask>(task)) {
      case ControllerTask::match:
      case ControllerTask::background: match_us_ += spent_us; break;
      case ControllerTask::undistort:
      case ControllerTask::map: other_us_ += spent_us; break;
      case ControllerTask::can:
      case ControllerTask::serial:
      case ControllerTask::odometry:
      case ControllerTask::report: break;
    }
  }
  void reset() { match_us_ = other_us_ = 0.0; }
  [[nodiscard]] double total_us() const { return match_us_ + other_us_; }
  [[nodiscard]] double match_us() const { return match_us_; }

 private:
  const Pipeline& pipeline_;
  bool was_busy_ = false;
  double match_us_ = 0.0;  // searches included
  double other_us_ = 0.0;
};

}  // namespace picolo::tool
