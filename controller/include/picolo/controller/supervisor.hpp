// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Watches devices, matches and the cycle itself; decides the health state and writes the events.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/controller/controller_config.hpp"
#include "picolo/controller/devices.hpp"
#include "picolo/controller/pipeline.hpp"
#include "picolo/controller/pose_composer.hpp"
#include "picolo/executive/schedule.hpp"
#include "picolo/localisation/event_ring.hpp"
#include "picolo/localisation/health.hpp"
#include "picolo/localisation/pose_trust.hpp"

namespace picolo::inline v0 {

/// Context: cycle only. Cost: every call O(1), `update` O(tasks).
class Supervisor {
 public:
  /// `events` outlives the supervisor and is attached.
  Supervisor(const HealthConfig& health, const MatchTrust& trust, EventRing& events)
      : monitor_(health), trust_(trust), events_(events) {}

  /// Ages count from here. `kept`: the ring holds events of the run before.
  void start(Timestamp now, bool kept);
  /// The configuration was refused: fault, for good.
  void refuse_configuration() { configuration_refused_ = true; }
  /// A device delivered a measurement of that stamp.
  void heard(DeviceIndex device, Timestamp stamp);
  /// What a device's line answered last; changes to and from `disconnected` become events.
  void line(DeviceIndex device, Status status, Timestamp now);
  /// `correction`: what it did to the published pose; nothing when it is not accepted.
  /// True when it leapt: the pose may be anywhere from now on.
  bool matched(const MatchVerdict& verdict, const PoseCorrection& correction = {});
  /// Wheels and gyro turn differently, or no longer.
  void turns(bool disagree) { turns_disagree_ = disagree; }
  /// Sensors whose own streams cannot be true; what is new becomes an event.
  void doubted(Timestamp now, SensorDoubts sensors);
  /// The vehicle leans, or no longer.
  void tilted(bool tilted) { tilted_ = tilted; }
  /// The wheels alone tell a turn that no match has confirmed.
  void turn_unverified(bool unverified) { turn_unverified_ = unverified; }
  /// The localiser is searching; it cannot tell where the pose is (see LocaliserCore::verify), or
  /// not which of several places.
  void searching(bool searching, bool unverified = false, bool ambiguous = false) {
    searching_ = searching;
    unverified_ = unverified;
    ambiguous_ = ambiguous;
  }
  /// The pose that the controller starts with is to be proven first.
  void distrust() { trust_.distrust(); }
  /// The pose was lost, or the sensors have just contradicted each other, and what is seen from it
  /// has not been seen to fit since: nothing of it should be remembered.
  [[nodiscard]] bool doubts_pose() const {
    return unproven() || trust_.holds_map() || state() == HealthState::lost ||
           state() == HealthState::relocalising;
  }
  /// The pose was lost, set or drawn along, and what is seen from it does not yet fit well.
  [[nodiscard]] bool unproven() const { return trust_.unproven(); }
  void event(Timestamp now, EventCode code, std::int32_t argument);
  /// Counts of the pipeline; what is new becomes an event, at most one of a kind a second.
  void sweeps(Timestamp now, std::uint32_t replaced, std::uint32_t dropped);
  /// A command has set the pose: trust begins anew.
  void pose_set(Timestamp now);
  /// Counts of refused commands and of frames of somebody else with our identifiers; what is new
  /// becomes an event, at most one of a kind a second.
  void command_refused(Timestamp now, std::uint32_t count) {
    tell(now, EventCode::command_refused, count, refused_);
  }
  void impersonated(Timestamp now, std::uint32_t count) {
    tell(now, EventCode::impersonated, count, impersonated_);
  }
  /// Judges everything. `estimate` is the last published.
  void update(Timestamp now, const PoseEstimate& estimate, const Schedule& schedule);

  [[nodiscard]] HealthState state() const { return monitor_.state(); }
  [[nodiscard]] HealthReason reason() const { return monitor_.reason(); }
  [[nodiscard]] SensorDoubts doubts() const { return doubts_; }
  [[nodiscard]] const EventRing& events() const { return events_; }
  [[nodiscard]] bool connected(DeviceIndex device) const { return watch(device).connected; }

 private:
  struct Watch {
    Timestamp last{};
    bool connected = true;
  };
  [[nodiscard]] const Watch& watch(DeviceIndex device) const {
    return watches_[static_cast<std::size_t>(device)];
  }
  [[nodiscard]] Duration age(DeviceIndex device, Timestamp now) const {
    return now - watch(device).last;
  }
  [[nodiscard]] bool contradicted() const;
  void report_cycle(Timestamp now, const Schedule& schedule);

  HealthMonitor monitor_;
  PoseTrust trust_;
  EventRing& events_;
  std::array<Watch, kDeviceCount> watches_{};
  std::array<std::uint32_t, kControllerTasks> overruns_{};
  struct Trouble {
    std::uint32_t told = 0;
    Timestamp last{};
    bool any = false;
  };
  void tell(Timestamp now, EventCode code, std::uint32_t count, Trouble& trouble);

  Trouble replaced_{};
  Trouble dropped_{};
  Trouble refused_{};
  Trouble impersonated_{};
  std::uint32_t slipped_ = 0;
  std::uint32_t cycle_troubles_ = 0;  // overruns and slipped frames
  bool direction_unobservable_ = false;
  bool turns_disagree_ = false;
  bool tilted_ = false;
  bool turn_unverified_ = false;
  SensorDoubts doubts_ = 0;
  bool searching_ = false;
  bool unverified_ = false;
  bool ambiguous_ = false;
  bool configuration_refused_ = false;
};

}  // namespace picolo::inline v0
