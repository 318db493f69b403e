// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which nodes turn which wheels, and where in their TPDOs the positions are.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/time.hpp"
#include "picolo/drivers/canopen/cob_id.hpp"
#include "picolo/drivers/canopen/node_monitor.hpp"
#include "picolo/drivers/canopen/pdo_mapping.hpp"
#include "picolo/drivers/canopen/pdo_setup.hpp"
#include "picolo/drivers/common/sync_pairing.hpp"
#include "picolo/drivers/common/wheel_counter.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0 {

/// One wheel: the TPDO that carries its position, and how that counts.
struct CanopenWheelConfig {
  std::uint8_t node = 1;
  std::uint16_t cob_id = 0;  ///< of the TPDO; 0 = the node's TPDO1
  canopen::PdoMapping mapping{{{canopen::kPositionActual402, 0, 32}}};
  std::uint16_t position_index = canopen::kPositionActual402;
  std::uint8_t position_subindex = 0;
  bool position_is_signed = true;
  std::uint16_t velocity_index = 0;  ///< 0 = none
  std::uint8_t velocity_subindex = 0;
  canopen::WheelCounterConfig counter{};

  [[nodiscard]] constexpr std::uint16_t pdo_id() const {
    return cob_id != 0 ? cob_id : canopen::tpdo_id(1, node);
  }
  /// 1 to 4: which of the node's TPDOs it is.
  [[nodiscard]] constexpr int pdo_number() const {
    for (int number = 2; number <= 4; ++number) {
      if (pdo_id() == canopen::tpdo_id(number, node)) { return number; }
    }
    return 1;
  }
  [[nodiscard]] constexpr bool valid() const {
    const auto position = canopen::find_field(mapping, position_index, position_subindex);
    return canopen::is_node(node) && pdo_id() > canopen::kSyncId + canopen::kMaxNode &&
           pdo_id() < canopen::kHeartbeatBase && position && position->bits <= 32 &&
           counter.modulus <= (std::uint64_t{1} << position->bits) &&
           canopen::total_bits(mapping) <= 64 && counter.valid() &&
           (velocity_index == 0 || canopen::find_field(mapping, velocity_index, velocity_subindex));
  }
};

/// Wheels that share a TPDO agree on its content and read different objects.
[[nodiscard]] constexpr bool compatible(const CanopenWheelConfig& a, const CanopenWheelConfig& b) {
  if (a.pdo_id() != b.pdo_id()) { return true; }
  return a.node == b.node && a.mapping == b.mapping &&
         (a.position_index != b.position_index || a.position_subindex != b.position_subindex);
}

struct CanopenWheelsConfig {
  /// Left wheel first, right wheel second; wheels of one node may share a TPDO.
  std::array<CanopenWheelConfig, kMaxWheels> wheels{{{.node = 1}, {.node = 2}}};
  int wheel_count = 2;
  bool produce_sync = false;  ///< else another node does, or the TPDOs are timer driven
  Duration sync_period = 10ms;
  /// Object 0x1019: 0 = SYNC without counter, else 2 to 240.
  std::uint8_t sync_counter_overflow = 0;
  Duration pair_window = 8ms;  ///< see SyncPairingConfig
  canopen::NodeMonitorConfig nodes{};
  canopen::PdoSetupConfig setup{};  ///< whether the nodes are taught their TPDOs

  [[nodiscard]] constexpr bool valid() const {
    if (wheel_count < 1 || wheel_count > kMaxWheels) { return false; }
    for (std::size_t i = 0; i < static_cast<std::size_t>(wheel_count); ++i) {
      if (!wheels[i].valid()) { return false; }
      for (std::size_t k = 0; k < i; ++k) {
        if (!compatible(wheels[i], wheels[k])) { return false; }
      }
    }
    return sync_period > Duration{0} && pair_window > Duration{0} && sync_counter_overflow != 1 &&
           sync_counter_overflow <= 240 && nodes.valid();
  }
};

/// Two CiA 402 drives, i32 position in TPDO1.
[[nodiscard]] constexpr CanopenWheelsConfig two_cia402_drives(std::uint8_t left_node,
                                                              std::uint8_t right_node) {
  CanopenWheelsConfig config;
  config.wheels[0].node = left_node;
  config.wheels[1].node = right_node;
  return config;
}

/// One CiA 402 dual drive: 0x6064 of axis 1 and of axis 2 (0x6864, the profile's second axis) in
/// TPDO1.
[[nodiscard]] constexpr CanopenWheelsConfig dual_cia402_drive(std::uint8_t node) {
  CanopenWheelsConfig config;
  for (std::size_t i = 0; i < 2; ++i) {
    config.wheels[i].node = node;
    config.wheels[i].mapping = {{{0x6064, 0, 32}, {0x6864, 0, 32}}};
    config.wheels[i].position_index = i == 0 ? 0x6064 : 0x6864;
  }
  return config;
}

/// Two CiA 406 encoders, u32 position in TPDO1, that wrap at their total range (object 0x6002).
[[nodiscard]] constexpr CanopenWheelsConfig two_cia406_encoders(std::uint8_t left_node,
                                                                std::uint8_t right_node,
                                                                std::uint64_t modulus) {
  CanopenWheelsConfig config = two_cia402_drives(left_node, right_node);
  for (std::size_t i = 0; i < 2; ++i) {
    config.wheels[i].mapping = {{{canopen::kPosition406, 0, 32}}};
    config.wheels[i].position_index = canopen::kPosition406;
    config.wheels[i].position_is_signed = false;
    config.wheels[i].counter.modulus = modulus;
  }
  return config;
}

static_assert(two_cia402_drives(1, 2).valid() && dual_cia402_drive(5).valid());
static_assert(two_cia406_encoders(3, 4, 1'000'003).valid());

}  // namespace picolo::inline v0
