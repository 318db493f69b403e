// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Hokuyo lidars (URG, UTM, UST on USB or RS-232) and others that speak SCIP 2.0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/core/time.hpp"
#include "picolo/drivers/common/serial_shell.hpp"
#include "picolo/drivers/scip/scip_scan.hpp"
#include "picolo/drivers/scip/scip_text.hpp"
#include "picolo/sensing/device_clock.hpp"
#include "picolo/sensing/range_return.hpp"

namespace picolo::inline v0 {

struct ScipConfig {
  /// Used until the device has told its own (answer to PP).
  ScipModel model{};
  /// From the first step of a scan to the first byte of its answer, at the fastest. Less than
  /// nothing = the time that the scan itself takes.
  Duration latency{-1};
  bool use_device_clock = true;
  /// Scans are rare: the fastest delivery is looked for among ten and more of them.
  DeviceClockConfig clock{
      .wrap = Duration{std::int64_t{16'777'216} * 1000}, .resolution = 1ms, .window = 1s};
  bool active = true;  ///< switches the laser on and asks for scans; false: only listens
  Duration answer_timeout = 500ms;
  Duration silence_timeout = 1500ms;
  [[nodiscard]] constexpr bool valid() const {
    return model.valid() && clock.valid() && answer_timeout > Duration{0} &&
           silence_timeout > Duration{0};
  }
};

/// Pure, see SerialProtocol. A scan is handed out when its last line has come: a revolution is one
/// scan, stamped from its first step on.
class ScipProtocol {
 public:
  using Sample = RangeReading;
  using Config = ScipConfig;
  static constexpr std::size_t kMaxSamplesPerByte = 1;  ///< readings come from `pull`
  static constexpr std::size_t kMaxRequest = 20;

  explicit ScipProtocol(const ScipConfig& config = {});

  std::size_t push(std::uint8_t byte, const ByteTime& time, std::span<RangeReading> readings);
  /// The readings of a complete scan, as many as fit. Take all before the next `push`.
  std::size_t pull(std::span<RangeReading> readings);
  std::size_t request(Timestamp now, std::span<std::uint8_t> out);
  std::size_t farewell(std::span<std::uint8_t> out);
  void interrupted();
  [[nodiscard]] const ScipModel& model() const { return config_.model; }
  [[nodiscard]] const ScipScan& scan() const { return scan_; }
  /// A complete scan waits in `scan()`.
  [[nodiscard]] bool scan_ready() const { return next_value_ < scan_values_; }
  /// When its first step was measured.
  [[nodiscard]] Timestamp scan_start() const { return scan_start_; }
  [[nodiscard]] SerialCounters counters() const;

 private:
  enum class Step : std::uint8_t {
    quit,
    version,
    parameters,
    await,
    laser,
    start,
    scanning,
    resting
  };

  void end_line(const ByteTime& time);
  void begin_scan(const ScipCommand& command);
  bool two_lines(std::size_t start, ByteView text);
  void end_scan(std::size_t offset);
  void text_line(ByteView text, const ByteTime& time);
  [[nodiscard]] bool believable(const ScipCommand& command);
  [[nodiscard]] Duration step_time(std::uint32_t steps) const;
  std::size_t ask(const char* text, Step next, Timestamp deadline, std::span<std::uint8_t> out);
  std::size_t ask_scans(Timestamp now, std::span<std::uint8_t> out);

  ScipConfig config_;
  DeviceClock clock_;
  ScipScan scan_{};
  std::array<std::uint8_t, 2 * (kScipLineLength + 2)> line_{};
  std::size_t line_size_ = 0;
  std::size_t line_start_ = 0;  ///< bytes since the echo
  std::size_t offset_ = 0;
  bool in_scan_ = false;
  ScipCommand command_{};  ///< of the last scan
  ScipCommand rumour_{};   ///< another one that was read once
  bool has_command_ = false;
  bool scan_waits_ = false;  ///< its echo was read while the scan before was not taken yet
  ScipCommand next_echo_{};
  Timestamp echo_at_{};
  Timestamp scan_start_{};
  Timestamp last_stamp_ = Timestamp::min();
  std::size_t next_value_ = 0;
  std::size_t scan_values_ = 0;
  Step step_ = Step::quit;
  Timestamp deadline_ = Timestamp::min();
  bool model_known_ = false;
  SerialCounters counters_{};
};

using Scip = SerialShell<ScipProtocol>;

}  // namespace picolo::inline v0
