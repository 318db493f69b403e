// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// YDLIDAR X2, X4, G4, TX and T-mini lidars on a serial line.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/time.hpp"
#include "picolo/drivers/common/sample_timeline.hpp"
#include "picolo/drivers/common/serial_shell.hpp"
#include "picolo/drivers/common/turn_cutter.hpp"
#include "picolo/drivers/ydlidar/ydlidar_packet.hpp"
#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

/// The receiver sits beside the emitter: near things are seen at another angle than the nominal.
enum class YdlidarOptics : std::uint8_t {
  aligned,     ///< no correction: T-mini, TG
  triangular,  ///< X2, X4, G4: atan(21.8 (155.3 - d) / (155.3 d)), d in mm
  short_base,  ///< SCL: atan(17.8 / d)
};

struct YdlidarConfig {
  /// 2 or 3; 0 = find out: the first packets may have either.
  std::uint8_t sample_bytes = 0;
  YdlidarOptics optics = YdlidarOptics::triangular;
  std::uint32_t samples_per_second = 5000;  ///< X4 5000, G4 9000, X2 3000
  Duration latency{0};
  bool active = true;  ///< asks for the scan; false: only listens
  Duration silence_timeout = 1500ms;
  [[nodiscard]] constexpr bool valid() const {
    return (sample_bytes == 0 || sample_bytes == 2 || sample_bytes == 3) &&
           samples_per_second > 0 && samples_per_second <= 1'000'000 && latency >= Duration{0} &&
           silence_timeout > Duration{0};
  }
};

/// One sample as the wire carries it.
struct YdlidarPoint {
  std::uint16_t distance_mm = 0;  ///< 0 = nothing measured
  std::uint8_t intensity = 0;     ///< 0 with two bytes a sample
  std::uint8_t flags = 0;         ///< with three bytes: 2 glass, 3 sunlight
  std::uint16_t angle_q6 = 0;     ///< clockwise, degrees * 64, before the optics' correction
};

/// Pure, see SerialProtocol. A revolution starts where the angle passes zero; the device's zero
/// packet would be a second rule, and one that can be lost.
class YdlidarProtocol {
 public:
  using Sample = RangeReading;
  using Config = YdlidarConfig;
  static constexpr std::size_t kMaxSamplesPerByte = YdlidarFormat::kMaxFrame / 2;
  static constexpr std::size_t kMaxRequest = 4;

  explicit YdlidarProtocol(const YdlidarConfig& config = {});

  std::size_t push(std::uint8_t byte, const ByteTime& time, std::span<RangeReading> readings);
  std::size_t request(Timestamp now, std::span<std::uint8_t> out);
  std::size_t farewell(std::span<std::uint8_t> out);
  void interrupted();
  /// Header and samples of the last packet.
  [[nodiscard]] const YdlidarHeader& header() const { return header_; }
  [[nodiscard]] std::span<const YdlidarPoint> points() const {
    return std::span{points_}.first(header_.count);
  }
  /// 0 = not known yet.
  [[nodiscard]] std::size_t sample_bytes() const { return framer_.format().sample_bytes; }
  [[nodiscard]] SerialCounters counters() const;

 private:
  void read_points(ByteView packet);
  void convert(std::span<RangeReading> readings);
  void settle_width();

  YdlidarConfig config_;
  Framer<YdlidarFormat> framer_;
  SampleTimeline timeline_;
  YdlidarHeader header_{};
  std::array<YdlidarPoint, kYdlidarMaxSamples> points_{};
  TurnCutter cutter_{360 * 64};
  std::uint32_t bad_before_ = 0;
  Timestamp deadline_ = Timestamp::min();
  bool asked_ = false;
  bool resting_ = false;
  std::uint32_t samples_ = 0;
  std::uint32_t restarts_ = 0;
};

using Ydlidar = SerialShell<YdlidarProtocol>;

}  // namespace picolo::inline v0
