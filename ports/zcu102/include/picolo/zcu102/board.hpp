// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Where the devices of a Zynq UltraScale+ are, and which interrupts of the GIC are theirs
/// (UG1085).
#pragma once

#include <cstdint>

namespace picolo::inline v0::zcu102 {

inline constexpr std::uintptr_t kUart0 = 0xFF00'0000;
inline constexpr std::uintptr_t kUart1 = 0xFF01'0000;
inline constexpr std::uintptr_t kCan0 = 0xFF06'0000;
inline constexpr std::uintptr_t kCan1 = 0xFF07'0000;

inline constexpr std::uint32_t kWatchdogInterrupt = 27;    ///< virtual timer of the processor
inline constexpr std::uint32_t kCycleTimerInterrupt = 30;  ///< physical timer of the processor
inline constexpr std::uint32_t kUart0Interrupt = 53;
inline constexpr std::uint32_t kUart1Interrupt = 54;
inline constexpr std::uint32_t kCan0Interrupt = 55;
inline constexpr std::uint32_t kCan1Interrupt = 56;

}  // namespace picolo::inline v0::zcu102
