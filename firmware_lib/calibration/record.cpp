// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/record.hpp"

#include <algorithm>
#include <bit>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

// magic u32 | version u16 | payload bytes u16 | sequence u32 | reserved u32 | payload | crc u32
constexpr std::uint32_t kMagic = 0x4C434950U;  // "PICL"
constexpr std::size_t kHeader = 16;
constexpr std::size_t kValues1 = 15;
constexpr std::size_t kValues2 = 16;

using Values = std::array<double, kValues2>;

Values values_of(const CalibrationRecord& r) {
  return {r.drive.radius_left_m,    r.drive.radius_right_m,   r.drive.track_m,
          r.drive.base_T_lidar.x_m, r.drive.base_T_lidar.y_m, r.drive.base_T_lidar.theta_rad,
          r.drive_std[0],           r.drive_std[1],           r.drive_std[2],
          r.drive_std[3],           r.drive_std[4],           r.drive_std[5],
          r.time_offset_s,          r.gyro_bias_radps,        r.gyro_scale,
          r.gyro_offset_s};
}

CalibrationRecord record_of(const Values& v) {
  CalibrationRecord r;
  r.drive = {v[0], v[1], v[2], {v[3], v[4], v[5]}};
  std::copy_n(v.begin() + 6, 6, r.drive_std.begin());
  r.time_offset_s = v[12];
  r.gyro_bias_radps = v[13];
  r.gyro_scale = v[14];
  r.gyro_offset_s = v[15];
  r.calibrated = true;
  return r;
}

}  // namespace

void encode_record(const CalibrationRecord& record, std::uint32_t sequence,
                   std::span<std::uint8_t> bytes) {
  std::fill(bytes.begin(), bytes.end(), std::uint8_t{0xFF});
  store_u32_le(bytes, 0, kMagic);
  store_u16_le(bytes, 4, kCalibrationRecordVersion);
  store_u16_le(bytes, 6, static_cast<std::uint16_t>(8 * kValues2));
  store_u32_le(bytes, 8, sequence);
  store_u32_le(bytes, 12, 0);
  std::size_t at = kHeader;
  for (const double value : values_of(record)) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    store_u32_le(bytes, at, static_cast<std::uint32_t>(bits & 0xFFFFFFFFU));
    store_u32_le(bytes, at + 4, static_cast<std::uint32_t>(bits >> 32));
    at += 8;
  }
  store_u32_le(bytes, at, crc32(bytes.first(at)));
}

Status decode_record(std::span<const std::uint8_t> bytes, DecodedRecord& decoded) {
  if (std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b == 0xFF; })) {
    return Status::not_ready;
  }
  if (bytes.size() < kHeader + 4 || load_u32_le(bytes, 0) != kMagic) { return Status::corrupt; }
  const std::uint16_t version = load_u16_le(bytes, 4);
  const std::size_t payload = load_u16_le(bytes, 6);
  const std::size_t end = kHeader + payload;
  if (end + 4 > bytes.size() || load_u32_le(bytes, end) != crc32(bytes.first(end))) {
    return Status::corrupt;
  }
  decoded.version = version;
  decoded.sequence = load_u32_le(bytes, 8);
  if (version > kCalibrationRecordVersion) { return Status::unsupported; }
  const std::size_t count = version == 1 ? kValues1 : kValues2;
  if (version == 0 || payload != 8 * count) { return Status::corrupt; }
  Values values{};  // what an older version did not have stays 0
  for (std::size_t k = 0; k < count; ++k) {
    const std::uint64_t low = load_u32_le(bytes, kHeader + 8 * k);
    const std::uint64_t high = load_u32_le(bytes, kHeader + 8 * k + 4);
    values[k] = std::bit_cast<double>(low | (high << 32));
    if (!is_finite(values[k])) { return Status::corrupt; }
  }
  decoded.record = record_of(values);
  return Status::ok;
}

}  // namespace picolo::inline v0
