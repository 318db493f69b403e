// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Sizes: how much a controller can remember. Capacity is a template argument of storage;
/// algorithms see run-time views.
#pragma once

#include <concepts>
#include <cstddef>

namespace picolo::inline v0 {

template <typename P>
concept Profile = requires {
  { P::kWidth } -> std::convertible_to<int>;  // cells of the fine grid
  { P::kHeight } -> std::convertible_to<int>;
  { P::kCell_m } -> std::convertible_to<float>;
  { P::kFieldRadius } -> std::convertible_to<int>;  // cells over which the likelihood falls to 0
  { P::kReturns } -> std::convertible_to<std::size_t>;  // of one sweep
};

/// Microcontrollers of 256 KiB: a window of 20.5 m.
struct RoomProfile {
  static constexpr const char* kName = "room";
  static constexpr int kWidth = 256;
  static constexpr int kHeight = 256;
  static constexpr float kCell_m = 0.08F;
  static constexpr int kFieldRadius = 6;
  static constexpr std::size_t kReturns = 720;
};

/// Microcontrollers of 1 MiB: a window of 32 m.
struct HallProfile {
  static constexpr const char* kName = "hall";
  static constexpr int kWidth = 640;
  static constexpr int kHeight = 640;
  static constexpr float kCell_m = 0.05F;
  static constexpr int kFieldRadius = 10;
  static constexpr std::size_t kReturns = 1100;
};

/// Linux: a window of 102 m.
struct SiteProfile {
  static constexpr const char* kName = "site";
  static constexpr int kWidth = 2048;
  static constexpr int kHeight = 2048;
  static constexpr float kCell_m = 0.05F;
  static constexpr int kFieldRadius = 10;
  static constexpr std::size_t kReturns = 4096;
};

/// The coarse grid of the two-level match: cells of four times the size.
inline constexpr int kCoarseFactor = 4;

}  // namespace picolo::inline v0
