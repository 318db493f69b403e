// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Beams of somebody else's lidar, dressed as one revolution of an LD06.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/sim/ld06_wire.hpp"

namespace picolo::inline v0::sim {

/// One beam of a recorded scan, in the lidar frame.
struct RecordedBeam {
  float range_m = 0.0F;      ///< not positive, not finite or above 65.535 m: nothing came back
  float bearing_rad = 0.0F;  ///< counter-clockwise
};

/// A packet can only say where its first and its last point lie, in 0.01 deg; the points between
/// lie evenly. So packets are laid where the beams are: every beam is hit within 0.02 deg, exactly
/// when the beams lie evenly on whole hundredths. Points where there is no beam have range 0.
/// Angles never decrease within the revolution.
class BeamPackets {
 public:
  static constexpr std::size_t kMaxBeams = 4096;

  /// Starts a revolution. Beams beyond the capacity are left out; returns how many. Cost: O(n log
  /// n).
  std::size_t load(std::span<const RecordedBeam> beams);
  /// The next packet of the revolution (without stamp and speed); false when it has come round to
  /// 360 deg. The last packet may reach over 0 deg with empty points.
  [[nodiscard]] bool next(Ld06Packet& packet);

 private:
  struct Beam {
    double clockwise_cdeg = 0.0;  ///< [0, 36000)
    std::uint16_t range_mm = 0;
  };

  [[nodiscard]] static Beam to_beam(const RecordedBeam& beam);
  void lay_empty(std::int32_t end_cdeg, Ld06Packet& packet);
  [[nodiscard]] bool lay_evenly(Ld06Packet& packet);
  void lay_single(Ld06Packet& packet);
  [[nodiscard]] std::int32_t rounded_angle(std::size_t index) const;

  std::array<Beam, kMaxBeams> beams_{};
  std::size_t size_ = 0;
  std::size_t next_ = 0;      ///< first beam that is not on the wire yet
  std::int32_t at_cdeg_ = 0;  ///< packets so far end before this
};

}  // namespace picolo::inline v0::sim
