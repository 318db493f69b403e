// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// BNO080, BNO085 and BNO086 in their UART-RVC mode: 115200 baud, 100 Hz, 19 bytes: heading,
/// pitch, roll, acceleration, and no gyro.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/bytes.hpp"
#include "picolo/drivers/common/framer.hpp"
#include "picolo/drivers/common/serial_shell.hpp"
#include "picolo/sensing/imu_sample.hpp"

namespace picolo::inline v0 {

inline constexpr std::size_t kBno08xRvcFrameSize = 19;

struct Bno08xRvcFrame {
  std::uint8_t index = 0;  ///< counts frames, 255 is followed by 0
  std::int16_t yaw_cdeg = 0;
  std::int16_t pitch_cdeg = 0;
  std::int16_t roll_cdeg = 0;
  std::array<std::int16_t, 3> acceleration_mg{};
};

/// Precondition: bytes.size() >= kBno08xRvcFrameSize; checked.
[[nodiscard]] Bno08xRvcFrame parse_bno08x_rvc(ByteView bytes);

/// AA AA, sum of bytes 2 to 17, angles in their range.
struct Bno08xRvcFormat {
  static constexpr std::size_t kMaxFrame = kBno08xRvcFrameSize;
  [[nodiscard]] FrameCheck check(ByteView bytes) const;
};

struct Bno08xRvcConfig {
  Duration period = 10ms;
  std::int16_t saturated_from_mg = 7990;  ///< the accelerometer ends at 8 g
  /// Lost frames over which a turn is still a rate; more begin anew.
  std::uint8_t max_gap = 5;
  [[nodiscard]] constexpr bool valid() const {
    return period > Duration{0} && saturated_from_mg > 0 && max_gap > 0 && max_gap < 128;
  }
};

/// Pure, see SerialProtocol. The yaw rate is the difference of two headings, stamped at the later
/// one; the first frame after a gap gives none. Rates about x and y are 0.
class Bno08xRvcProtocol {
 public:
  using Sample = ImuSample;
  using Config = Bno08xRvcConfig;
  static constexpr std::size_t kMaxSamplesPerByte = 1;

  explicit Bno08xRvcProtocol(const Bno08xRvcConfig& config = {}) : config_(config) {}

  std::size_t push(std::uint8_t byte, const ByteTime& time, std::span<ImuSample> samples);
  void interrupted();
  /// True when the last `push` completed `frame()`, sample or not.
  [[nodiscard]] bool frame_ready() const { return frame_ready_; }
  [[nodiscard]] const Bno08xRvcFrame& frame() const { return frame_; }
  [[nodiscard]] SerialCounters counters() const;

 private:
  Bno08xRvcConfig config_;
  Framer<Bno08xRvcFormat> framer_{};
  Bno08xRvcFrame frame_{};
  bool frame_ready_ = false;
  bool has_last_ = false;
  Timestamp last_stamp_ = Timestamp::min();
  SerialCounters counters_{};
};

using Bno08xRvc = SerialShell<Bno08xRvcProtocol>;

}  // namespace picolo::inline v0
