// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Where commands act.
#pragma once

#include <array>
#include <cstdint>

#include "picolo/controller/command_gate.hpp"
#include "picolo/controller/pipeline.hpp"
#include "picolo/controller/pose_composer.hpp"
#include "picolo/controller/reporter.hpp"
#include "picolo/controller/services.hpp"
#include "picolo/controller/supervisor.hpp"
#include "picolo/hal/can_filter.hpp"

namespace picolo::inline v0 {

/// Context: cycle only. Cost: each call O(1), `work` one slice of each service.
class CommandDesk {
 public:
  /// Everything referred to outlives the desk.
  CommandDesk(const FramesOutConfig& config, const ControllerServices& services, Pipeline& pipeline,
              PoseComposer& composer, Supervisor& supervisor, Reporter& reporter)
      : base_id_(config.base_id),
        enabled_(config.enabled),
        services_(services),
        pipeline_(pipeline),
        composer_(composer),
        supervisor_(supervisor),
        reporter_(reporter),
        gate_(config.base_id) {}

  /// Takes a frame; false when its identifier is none of ours.
  bool consume(const CanFrame& frame, Timestamp now);
  /// What takes longer than a command.
  void work(Timestamp now);
  /// A calibration is under way.
  [[nodiscard]] bool serving() const;

  [[nodiscard]] OperatingMode mode() const { return mode_; }
  [[nodiscard]] const CommandCounters& counters() const { return gate_.counters(); }
  /// Frames of somebody else with an identifier of the controller.
  [[nodiscard]] std::uint32_t impersonated() const { return impersonated_; }
  [[nodiscard]] const ControllerServices& services() const { return services_; }

 private:
  enum class MapJobPhase : std::uint8_t { none, waiting, running };

  void receive(const Receipt& receipt, Timestamp now);
  [[nodiscard]] CommandResult act(const Command& command, Timestamp now);
  [[nodiscard]] CommandResult set_pose(const Pose2d& map_T_base, Timestamp now);
  [[nodiscard]] CommandResult set_mode(std::uint8_t mode, Timestamp now);
  [[nodiscard]] CommandResult begin_map_job(const Command& command);
  /// `not_ready`: more to do.
  [[nodiscard]] Status map_job_slice();
  void answer(const Command& command, CommandResult result);

  std::uint16_t base_id_;
  bool enabled_;
  ControllerServices services_;
  Pipeline& pipeline_;
  PoseComposer& composer_;
  Supervisor& supervisor_;
  Reporter& reporter_;
  CommandGate gate_;
  OperatingMode mode_ = OperatingMode::mapping;
  Command map_job_{};
  MapJobPhase map_job_phase_ = MapJobPhase::none;
  std::uint32_t impersonated_ = 0;
  Timestamp last_refusal_told_{};
  bool refusal_told_ = false;
};

/// What a port must let pass for commands, and to notice a foreign talker.
[[nodiscard]] constexpr std::array<CanFilter, 2> command_filters(const FramesOutConfig& config) {
  return {CanFilter{.id = config.base_id, .mask = 0x7F0},
          CanFilter{.id = static_cast<std::uint32_t>(config.base_id + kCanOwnIds), .mask = 0x7F0}};
}

}  // namespace picolo::inline v0
