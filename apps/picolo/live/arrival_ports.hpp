// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Ports that play captures by their arrival times, where nobody wrote down the cycles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "live/record_folder.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/host/diagnostics.hpp"

namespace picolo::tool {

struct SerialChunkRecord {
  Timestamp stamp{};  ///< of its last byte
  std::size_t begin = 0;
  std::size_t size = 0;
};

struct SerialCapture {
  std::vector<std::uint8_t> bytes;
  std::vector<SerialChunkRecord> chunks;
  std::optional<std::uint32_t> baud;  ///< that the stamps name, the last where there are several
};

/// All of a capture folder, on one clock.
struct Captures {
  std::vector<CanFrame> can;  ///< by stamp
  SerialCapture lidar;
  std::optional<SerialCapture> imu;
  Timestamp begin{};
  Timestamp end{};
};

/// can.log or the one candump*.log, lidar.raw and imu.raw, each with .stamps or, with a warning,
/// spread evenly over the time of the CAN log. Frames with identifiers from `own_id` on are the
/// controller's own and left out. Throws UserError (input).
[[nodiscard]] Captures read_captures(const RecordFolder& folder, std::uint32_t own_id,
                                     host::Diagnostics& diagnostics);

class ArrivalCanBus final : public CanBus {
 public:
  ArrivalCanBus(Clock& clock, const std::vector<CanFrame>& frames)
      : clock_(clock), frames_(frames) {}
  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& /*frame*/) override { return Status::ok; }
  [[nodiscard]] CanStatus status() const override { return {}; }

 private:
  Clock& clock_;
  const std::vector<CanFrame>& frames_;
  std::size_t next_ = 0;
};

class ArrivalSerialPort final : public SerialPort {
 public:
  /// `baud` is used where the capture names none.
  ArrivalSerialPort(Clock& clock, const SerialCapture* capture, std::uint32_t baud)
      : clock_(clock),
        capture_(capture),
        baud_(capture != nullptr ? capture->baud.value_or(baud) : baud) {}
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override;
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override { return bytes.size(); }
  [[nodiscard]] std::uint32_t baud() const override { return baud_; }
  [[nodiscard]] std::uint32_t lost() const override { return 0; }

 private:
  Clock& clock_;
  const SerialCapture* capture_;
  std::uint32_t baud_;
  std::size_t chunk_ = 0;
  std::size_t taken_ = 0;  ///< of that chunk
};

}  // namespace picolo::tool
