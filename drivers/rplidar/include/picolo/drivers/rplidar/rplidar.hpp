// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// RPLIDAR A, S and C series on a serial line: asks for identity and health, turns the motor,
/// starts the scan, and starts it again when the device falls silent.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/time.hpp"
#include "picolo/drivers/common/sample_timeline.hpp"
#include "picolo/drivers/common/serial_shell.hpp"
#include "picolo/drivers/rplidar/rplidar_capsule.hpp"
#include "picolo/drivers/rplidar/rplidar_messages.hpp"
#include "picolo/drivers/rplidar/rplidar_standard.hpp"
#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

enum class RplidarMotor : std::uint8_t {
  automatic,  ///< turns while scanning, or by the line's DTR (A1)
  pwm,        ///< A2, A3: motor_value 0 to 1023, 660 usual
  rpm,        ///< S and C series: turns a minute
};

struct RplidarConfig {
  RplidarMode mode = RplidarMode::standard;
  /// Payload byte 0 of an express request: which of the device's scan modes.
  std::uint8_t express_mode = 0;
  /// A1 2000 in standard and 4000 in express mode, A3 16000, S1 9200, S2 32000, C1 5000.
  std::uint32_t samples_per_second = 2000;
  RplidarMotor motor = RplidarMotor::automatic;
  std::uint16_t motor_value = 660;
  Duration latency{0};  ///< from the measurement of a packet's last node to its first bit
  /// False: only listen, to a stream that somebody else started in `mode`.
  bool active = true;
  Duration answer_timeout = 500ms;
  Duration silence_timeout = 1500ms;  ///< without a node: started again
  [[nodiscard]] constexpr bool valid() const {
    return samples_per_second > 0 && samples_per_second <= 1'000'000 && motor_value <= 1500 &&
           latency >= Duration{0} && answer_timeout > Duration{0} &&
           silence_timeout > answer_timeout;
  }
};

/// Why there are no readings.
enum class RplidarTrouble : std::uint8_t {
  none,
  no_bytes,       ///< nothing comes: no power, wrong port
  no_descriptor,  ///< bytes come, but no answer among them: wrong baud rate
  unhealthy,      ///< the device reports an error: often a supply below 4.9 V
  no_nodes,       ///< it answers, but no packet is whole: wrong mode, or a bad line
};

/// Pure: bytes and times in, readings and requests out. See SerialProtocol.
class RplidarProtocol {
 public:
  using Sample = RangeReading;
  using Config = RplidarConfig;
  static constexpr std::size_t kMaxSamplesPerByte = kRplidarMaxNodes;
  static constexpr std::size_t kMaxRequest = kRplidarMaxRequest;

  explicit RplidarProtocol(const RplidarConfig& config = {});

  std::size_t push(std::uint8_t byte, const ByteTime& time, std::span<RangeReading> readings);
  /// The nodes behind the readings of the last `push`, in the units of the wire.
  [[nodiscard]] std::span<const RplidarNode> nodes() const {
    return std::span{nodes_}.first(node_count_);
  }
  /// The stream has ended (a file): like push for the nodes that still wait. Call until 0.
  std::size_t flush();
  std::size_t request(Timestamp now, std::span<std::uint8_t> out);
  std::size_t farewell(std::span<std::uint8_t> out);
  void interrupted();

  [[nodiscard]] RplidarTrouble trouble() const { return trouble_; }
  [[nodiscard]] RplidarHealth health() const { return health_; }
  [[nodiscard]] const RplidarInfo& info() const { return info_; }
  [[nodiscard]] SerialCounters counters() const;

 private:
  enum class Step : std::uint8_t {
    stop,
    settle,
    info,
    await_info,
    health,
    await_health,
    motor,
    scan,
    await_scan,
    scanning,
    resting,
  };

  void enter(Step step, Timestamp deadline);
  void start_over(Timestamp now, RplidarTrouble trouble);
  void descriptor(const RplidarDescriptor& descriptor, Timestamp now);
  void answer(std::uint8_t byte);
  std::size_t scan_request(std::span<std::uint8_t> out) const;
  std::size_t motor_request(std::uint16_t value, std::span<std::uint8_t> out) const;
  void decode(std::uint8_t byte);
  Timestamp measured_before(const ByteTime& time);

  RplidarConfig config_;
  RplidarStandardDecoder standard_{};
  RplidarCapsules capsules_;
  RplidarDescriptorFinder descriptors_{};
  SampleTimeline timeline_;
  RplidarMode mode_;
  Step step_ = Step::stop;
  Timestamp deadline_ = Timestamp::min();
  std::uint32_t bytes_since_step_ = 0;  ///< or since the last node
  std::array<std::uint8_t, 20> answer_{};
  std::size_t answer_size_ = 0;
  std::size_t answer_length_ = 0;
  std::uint8_t answer_type_ = 0;
  std::array<RplidarNode, kRplidarMaxNodes> nodes_{};
  std::size_t node_count_ = 0;
  std::uint32_t capsules_taken_ = 0;
  Timestamp capsule_begin_{};    ///< first bit of the last one
  Timestamp completed_begin_{};  ///< first bit of the one that was complete last
  RplidarTrouble trouble_ = RplidarTrouble::none;
  RplidarHealth health_ = RplidarHealth::unknown;
  RplidarInfo info_{};
  std::uint32_t samples_ = 0;
  std::uint32_t restarts_ = 0;
};

using Rplidar = SerialShell<RplidarProtocol>;

}  // namespace picolo::inline v0
