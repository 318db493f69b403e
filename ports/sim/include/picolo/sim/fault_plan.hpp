// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What goes wrong, on which device, when and how often.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/random.hpp"
#include "picolo/core/time.hpp"

namespace picolo::inline v0::sim {

enum class Device : std::uint8_t { wheel_left, wheel_right, lidar, imu, can_bus };
inline constexpr std::size_t kDevices = 5;

/// The first four strike single frames or packets, with `probability`; the others hold for the
/// whole window.
enum class FaultKind : std::uint8_t {
  drop,     ///< the frame or packet never comes
  corrupt,  ///< one to three bits are flipped (on CAN in the payload, where no checksum of the wire
            ///< sees it)
  delay,    ///< it, and what follows on its line, comes later by `delay`
  duplicate,   ///< it comes twice
  silence,     ///< the device says nothing
  freeze,      ///< it repeats its last measurement, well-formed
  disconnect,  ///< serial: unplugged; can_bus: the controller is gone; wheel: power lost, it boots
               ///< anew at count 0
};
inline constexpr std::size_t kFaultKinds = 7;

/// One fault. Strikes of `can_bus` hit every frame of every node.
struct Fault {
  Device device = Device::lidar;
  FaultKind kind = FaultKind::drop;
  Duration begin{};  ///< since the start of the simulation, inclusive
  Duration end{};    ///< exclusive
  float probability = 1.0F;
  Duration delay{};  ///< for FaultKind::delay
  [[nodiscard]] constexpr bool valid() const {
    return begin <= end && probability >= 0.0F && probability <= 1.0F && delay >= Duration{0};
  }
};
inline constexpr std::size_t kMaxFaults = 32;
using FaultList = FixedVector<Fault, kMaxFaults>;

/// What happens to one frame or packet.
struct FaultVerdict {
  bool drop = false;
  bool corrupt = false;
  bool duplicate = false;
  Duration delay{};
};

struct FaultCounters {
  std::uint32_t dropped = 0;
  std::uint32_t corrupted = 0;
  std::uint32_t delayed = 0;
  std::uint32_t duplicated = 0;
};

/// Each fault draws from its own random stream: adding one does not change what the others do.
class FaultPlan {
 public:
  FaultPlan(std::uint64_t seed, const FaultList& faults);

  /// Judges one frame or packet of a device and counts the verdict.
  [[nodiscard]] FaultVerdict judge(Device device, Duration elapsed);
  /// Whether a fault that holds for its window (silence, freeze, disconnect) holds now.
  [[nodiscard]] bool active(Device device, FaultKind kind, Duration elapsed) const;
  /// Flips one to three bits. Precondition: not empty.
  void corrupt(std::span<std::uint8_t> bytes);
  [[nodiscard]] const FaultCounters& counters(Device device) const;

 private:
  FaultList faults_;
  std::array<Random, kMaxFaults> streams_;
  Random bits_;
  std::array<FaultCounters, kDevices> counters_{};
};

}  // namespace picolo::inline v0::sim
