// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The capsules of the express modes: 0x82 (84 bytes), 0x84 ultra (132 bytes), 0x85 dense.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/drivers/rplidar/rplidar_capsule_finder.hpp"
#include "picolo/drivers/rplidar/rplidar_node.hpp"

namespace picolo::inline v0 {

/// A capsule says where it starts, its successor where it ends: nodes come one capsule later. Where
/// the successor was lost, the capsule is laid out by the speed of the one before it.
/// Cost: O(1) a byte, O(nodes) a capsule, integers only. Context: one at a time.
class RplidarCapsules {
 public:
  /// Precondition: mode is not standard.
  explicit RplidarCapsules(RplidarMode mode = RplidarMode::express);

  /// Takes one byte and writes the nodes of the capsule before the one that it completes; returns
  /// how many: 0, 32, 96 or 40.
  std::size_t push(std::uint8_t byte, std::span<RplidarNode, kRplidarMaxNodes> nodes);
  [[nodiscard]] std::size_t capsule_size() const { return finder_.capsule_size(); }
  /// When above 0, a capsule has just become complete: from its first byte up to the one pushed
  /// last. The next that `push` takes in is this one.
  [[nodiscard]] std::size_t completed_bytes() const { return finder_.completed_bytes(); }
  /// Forgets what waits; a new stream begins.
  void reset(RplidarMode mode);
  [[nodiscard]] const FramerCounters& counters() const { return finder_.counters(); }
  /// Capsules whose angles no motor could make.
  [[nodiscard]] std::uint32_t implausible() const { return implausible_; }

 private:
  using Bytes = std::array<std::uint8_t, RplidarCapsuleFinder::kMaxCapsule>;

  [[nodiscard]] static std::int32_t start_q8(const Bytes& capsule);
  [[nodiscard]] bool starts_scan(std::int32_t angle_q16, std::int32_t step_q16);
  [[nodiscard]] RplidarNode make_node(std::int32_t angle_q16, std::uint32_t dist_mm_q2, bool sync);
  std::size_t decode_express(std::int32_t span_q8, std::span<RplidarNode> nodes);
  std::size_t decode_ultra(std::int32_t span_q8, const Bytes* next, std::span<RplidarNode> nodes);
  std::size_t decode_dense(std::int32_t span_q8, std::span<RplidarNode> nodes);

  RplidarMode mode_;
  RplidarCapsuleFinder finder_;
  Bytes previous_{};
  std::uint32_t previous_position_ = 0;  ///< in the stream
  std::int32_t last_span_q8_ = 0;        ///< 0 = not known
  bool has_previous_ = false;
  bool last_sync_ = false;
  std::uint32_t implausible_ = 0;
};

}  // namespace picolo::inline v0
