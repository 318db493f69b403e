// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A simulated drive under test: the installed controller, the truth beside it, and what a judge
/// wants to know.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <memory>
#include <vector>

#include "picolo/geometry/angle.hpp"
#include "picolo/simulated/simulated_controller.hpp"
#include "picolo/simulated/trajectory_hash.hpp"

namespace picolo::test {

inline sim::SimulationConfig drive_in(sim::SceneName scene,
                                      std::initializer_list<sim::Fault> faults = {}) {
  sim::SimulationConfig config{.seed = 11, .scene = sim::make_scene(scene)};
  for (const sim::Fault& fault : faults) { EXPECT_TRUE(config.faults.push_back(fault)); }
  return config;
}

/// One published pose beside the truth.
struct Publication {
  PoseEstimate estimate{};
  double position_error_m = 0.0;
  double heading_error_rad = 0.0;
  [[nodiscard]] bool wrong() const {
    return position_error_m > 0.20 || heading_error_rad > 3.0 * 3.14159265 / 180.0;
  }
};

class Drive {
 public:
  explicit Drive(const sim::SimulationConfig& simulation,
                 const ControllerConfig& config = simulated_vehicle_config())
      : robot_(std::make_unique<SimulatedController<RoomProfile>>(simulation, config)) {
    EXPECT_EQ(robot_->start(), Status::ok);
  }

  /// Runs the cycle until `elapsed` since the start of the simulation.
  void until(Duration elapsed, const std::function<void(const Publication&)>& judge = {}) {
    const Timestamp end = robot_->simulation().config().start + elapsed;
    while (controller().next_frame() < end) {
      ASSERT_EQ(robot_->run_frame(), Status::ok);
      const Publication publication = judged();
      note_silent_wrong(publication);
      if (judge) { judge(publication); }
    }
  }

  [[nodiscard]] Publication judged() const {
    Publication publication{.estimate = controller().estimate()};
    const PoseEstimate& estimate = publication.estimate;
    const Result<Pose2d> truth = robot_->true_map_T_base(estimate.stamp);
    if (!truth) { return publication; }
    publication.position_error_m =
        std::hypot(estimate.map_T_base.x_m - truth->x_m, estimate.map_T_base.y_m - truth->y_m);
    publication.heading_error_rad =
        std::abs(wrap_angle(estimate.map_T_base.theta_rad - truth->theta_rad));
    return publication;
  }

  [[nodiscard]] const SimulatedController<RoomProfile>::Type& controller() const {
    return robot_->controller();
  }
  [[nodiscard]] SimulatedController<RoomProfile>& robot() { return *robot_; }
  [[nodiscard]] HealthState state() const { return controller().supervisor().state(); }
  [[nodiscard]] HealthReason reason() const { return controller().supervisor().reason(); }
  /// States in the order in which they were entered.
  [[nodiscard]] std::vector<HealthState> states() const {
    std::vector<HealthState> entered;
    for (const Event& event : events(EventCode::state_changed)) { entered.push_back(event.to); }
    return entered;
  }
  [[nodiscard]] std::vector<Event> events(EventCode code) const {
    std::vector<Event> found;
    const EventRing& ring = robot_->events();
    for (std::size_t i = 0; i < ring.size(); ++i) {
      if (ring[i].code == code) { found.push_back(ring[i]); }
    }
    return found;
  }
  /// Publications that were the third or later in a row to be wrong while the state said tracking.
  [[nodiscard]] int silent_wrong() const { return silent_wrong_; }

 private:
  void note_silent_wrong(const Publication& publication) {
    const bool wrong = publication.wrong() && publication.estimate.state == HealthState::tracking;
    wrong_in_a_row_ = wrong ? wrong_in_a_row_ + 1 : 0;
    if (wrong_in_a_row_ >= 3) { ++silent_wrong_; }
  }

  std::unique_ptr<SimulatedController<RoomProfile>> robot_;
  int wrong_in_a_row_ = 0;
  int silent_wrong_ = 0;
};

}  // namespace picolo::test
