// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Points into the ultra capsules (0x84) of an RPLIDAR; the frame that all of its capsules have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace picolo::inline v0::devices {

/// Writes the sum over what follows into the first two bytes, four bits beside each mark.
void seal_capsule(std::vector<std::uint8_t>& capsule);

/// The device samples at even angles of its head, from which each beam looks aside by its optics;
/// so what a node says is the point whose beam comes nearest.
class UltraCapsules {
 public:
  /// Takes a point, clockwise; returns a capsule when one is full, else nothing.
  std::vector<std::uint8_t> push(std::uint32_t angle_q6, unsigned mm);

 private:
  struct Point {
    double head_deg = 0.0;
    unsigned mm = 0;
  };
  [[nodiscard]] unsigned node_mm(std::size_t node) const;
  [[nodiscard]] std::vector<std::uint8_t> capsule() const;

  std::vector<Point> points_;
  double angle_deg_ = 0.0;  ///< of the newest point, over all turns
  double start_deg_ = 0.0;  ///< of the capsule that fills
  bool started_ = false;
};

}  // namespace picolo::inline v0::devices
