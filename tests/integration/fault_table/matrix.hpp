// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Every kind of fault on every sensor, at instants of one drive. A process forks at each instant:
/// one child drives on without fault, the twin, and one child for each fault.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "subject.hpp"

namespace picolo::test {

inline constexpr Duration kFaultLength = 5s;
inline constexpr Duration kWatched = 8s;  // from the fault's begin on
inline constexpr std::size_t kFrames = 1600;

enum class Verdict : std::uint8_t {
  detected,
  tolerated,
  not_observable,
  not_claimed,  ///< the state did not say tracking anyway when the motion changed
  late,
  silent
};
inline constexpr std::size_t kVerdicts = 6;

/// What became of one fault.
struct Outcome {
  Fault fault{};
  Verdict verdict = Verdict::silent;
  /// Since the fused motion first differed from the twin's by 5 cm or 1 deg; negative: sooner.
  Duration delay{};
  bool told = false;
  HealthReason reason = HealthReason::none;  ///< first told
  double worst_m = 0.0;                      ///< error while tracking
  double worst_rad = 0.0;
  double worst_nees = 0.0;
  double nominal_nees = 0.0;
};

/// The twin of one instant, frame by frame.
using Twin = std::array<Publication, kFrames>;

/// `limit`: how soon after the fused motion differs a fault must be told.
[[nodiscard]] Outcome judge(const Fault& fault, const Twin& twin,
                            const std::vector<Publication>& faulty, Duration limit);

/// What the drives did without faults.
struct Nominal {
  double driven_s = 0.0;
  double untrusted_s = 0.0;           ///< of it, not tracking
  int alarms = 0;                     ///< times that tracking was left
  std::array<double, 16> reason_s{};  ///< of the time not tracking, by HealthReason
  double worst_m = 0.0;               ///< error while tracking, where the truth is known

  /// One publication, from `first` on; `before`: the state of the one before.
  void add(const Publication& p, HealthState before, Timestamp first);
  void add(const Nominal& other);
};

struct Cell {
  std::array<int, kVerdicts> counts{};
  Duration worst_delay{};  ///< of the detected
  double worst_m = 0.0;
  double worst_rad = 0.0;
  double worst_nees = 0.0;
};

struct Campaign {
  std::vector<Sensor> sensors;
  Duration lidar_period{100ms};
  bool leans = false;  ///< the vehicle, for 2 s from 1.5 s after the fault begins
  std::vector<Outcome> outcomes{};
  Nominal nominal{};
  int instants = 0;

  /// Drives `subject` through `wanted` instants, drawn from `seed` within [first, last).
  void drive(Subject& subject, std::uint64_t seed, int wanted, Timestamp first, Timestamp last);
  [[nodiscard]] std::vector<Timestamp> eligible(Subject& subject, Timestamp first, Timestamp last);
  void inject_at(Subject& subject, const std::vector<Fault>& faults, Twin& twin);
  [[nodiscard]] Cell cell(Sensor sensor, Kind kind) const;
  [[nodiscard]] int count(Verdict verdict) const;
  void print(const std::string& title) const;
};

}  // namespace picolo::test
