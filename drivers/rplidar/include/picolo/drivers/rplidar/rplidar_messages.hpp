// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Requests to an RPLIDAR and the descriptors that introduce its answers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0 {

enum class RplidarCommand : std::uint8_t {
  scan = 0x20,
  force_scan = 0x21,
  stop = 0x25,
  reset = 0x40,
  info = 0x50,
  health = 0x52,
  sample_rate = 0x59,
  express_scan = 0x82,
  motor_rpm = 0xA8,
  motor_pwm = 0xF0,
};

inline constexpr std::size_t kRplidarMaxRequest = 16;

/// Writes A5, the command, and with a payload its length, itself and the exclusive-or of all.
/// Returns the size; 0 when `out` is too small. Commands with payload have bit 7 set.
std::size_t encode_rplidar(RplidarCommand command, ByteView payload, std::span<std::uint8_t> out);

/// A5 5A, length and mode, type.
struct RplidarDescriptor {
  std::uint32_t length = 0;  ///< bytes of the answer, or of each packet of a stream
  std::uint8_t mode = 0;     ///< 1: a stream
  std::uint8_t type = 0;
};

/// Finds descriptors in any stream of bytes. Cost: O(1) a byte.
class RplidarDescriptorFinder {
 public:
  /// True when this byte ends a descriptor that the protocol knows.
  bool push(std::uint8_t byte);
  [[nodiscard]] const RplidarDescriptor& found() const { return found_; }

 private:
  std::array<std::uint8_t, 7> last_{};
  RplidarDescriptor found_{};
};

struct RplidarInfo {
  std::uint8_t model = 0;
  std::uint8_t firmware_minor = 0;
  std::uint8_t firmware_major = 0;
  std::uint8_t hardware = 0;
  std::array<std::uint8_t, 16> serial_number{};
};

enum class RplidarHealth : std::uint8_t { good = 0, warning = 1, error = 2, unknown = 255 };

}  // namespace picolo::inline v0
