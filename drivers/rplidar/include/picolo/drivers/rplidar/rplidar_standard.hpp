// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The nodes of a standard scan (0x81): five bytes and no checksum, only two check bits.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/core/status.hpp"
#include "picolo/drivers/common/framer.hpp"
#include "picolo/drivers/rplidar/rplidar_node.hpp"

namespace picolo::inline v0 {

/// Two bits find three of four damaged nodes at best. What they miss is found by looking ahead: a
/// lock is taken only on five nodes in a row whose angles follow one another, a node is believed
/// only when its angle follows its predecessor's, and a node behind which the stream continues out
/// of step is the one that lost or gained a byte. So nodes come four later than their bytes.
/// Cost: O(1) a byte. Context: one at a time.
class RplidarStandardDecoder {
 public:
  static constexpr std::size_t kNodeSize = 5;
  static constexpr std::size_t kLookAhead = 4;  ///< nodes

  /// Takes one byte. `ok`: `node()` is the next node. `not_ready`: it is not known yet.
  Status push(std::uint8_t byte);
  /// The stream has ended: like push, for the nodes that still wait. Call until `not_ready`.
  Status flush();
  [[nodiscard]] const RplidarNode& node() const { return node_; }
  /// Bytes that came after the last byte of `node()`.
  [[nodiscard]] std::size_t bytes_after_node() const { return size_; }
  void reset();
  /// bad_checksums: nodes with wrong check bits while locked; implausible: right ones that did not
  /// fit their neighbours.
  [[nodiscard]] const FramerCounters& counters() const { return counters_; }

 private:
  [[nodiscard]] bool checked(std::size_t at) const;
  [[nodiscard]] std::int32_t angle_q6(std::size_t at) const;
  [[nodiscard]] bool follows(std::size_t at) const;
  [[nodiscard]] bool run(std::size_t at) const;
  [[nodiscard]] bool out_of_step_behind() const;
  [[nodiscard]] bool believable() const;
  Status accept();
  Status reject();

  std::array<std::uint8_t, kNodeSize*(kLookAhead + 1)> window_{};
  std::size_t size_ = 0;
  std::int32_t last_angle_q6_ = 0;
  bool locked_ = false;
  RplidarNode node_{};
  FramerCounters counters_{};
};

}  // namespace picolo::inline v0
