// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The stored form of a calibration: bytes with version, sequence number and CRC-32.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/calibration/wheel_model.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

/// All that a commissioning finds. Defaults: not calibrated.
struct CalibrationRecord {
  DriveParameters drive{};
  std::array<double, 6> drive_std{};  ///< r_L, r_R, b, x, y, yaw
  double time_offset_s = 0.0;         ///< lidar data is older than its stamp by
  double gyro_bias_radps = 0.0;
  double gyro_scale = 1.0;
  double gyro_offset_s = 0.0;  ///< gyro data is older than its stamp by; since version 2
  bool calibrated = false;     ///< false: defaults, nothing was ever stored
};

/// Version 1 had no gyro_offset_s; it is read as 0.
inline constexpr std::uint16_t kCalibrationRecordVersion = 2;
/// Header 16, payload 128, CRC 4, filled up with 0xFF to a multiple of 8.
inline constexpr std::size_t kCalibrationRecordSize = 152;

struct DecodedRecord {
  CalibrationRecord record{};
  std::uint32_t sequence = 0;
  std::uint16_t version = 0;
};

/// Little-endian on every platform. Precondition: bytes.size() == kCalibrationRecordSize.
void encode_record(const CalibrationRecord& record, std::uint32_t sequence,
                   std::span<std::uint8_t> bytes);

/// `not_ready`: blank, all bytes 0xFF. `corrupt`: damaged. `unsupported`: whole, but of a newer
/// version (sequence and version are set). The CRC covers all before it, so every single flipped
/// bit and every burst up to 32 bits is seen.
Status decode_record(std::span<const std::uint8_t> bytes, DecodedRecord& decoded);

}  // namespace picolo::inline v0
