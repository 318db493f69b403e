// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Ports that write down what they deliver, cycle by cycle.
#pragma once

#include <cstdint>
#include <fstream>
#include <memory>
#include <string>

#include "live/drive_journal.hpp"
#include "live/record_folder.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::tool {

/// What each call answered, one letter a call, in the order of the calls of a cycle.
class CallTape {
 public:
  void add(char code) { text_ += code; }
  void add(const std::string& codes) { text_ += codes; }
  [[nodiscard]] std::string take();

 private:
  std::string text_;
};

/// The letter of an answer without data.
[[nodiscard]] char code_of(Status status);
[[nodiscard]] Status status_of(char code);
/// The letter of a frame or a chunk by where its stamp was taken, and back.
[[nodiscard]] char code_of(StampSource source);
[[nodiscard]] bool source_of(char code, StampSource& source);

class RecordingCanBus final : public CanBus {
 public:
  RecordingCanBus(CanBus& bus, const std::filesystem::path& log);
  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override;
  [[nodiscard]] CanStatus status() const override;
  void latch(Timestamp now) { now_ = now; }
  [[nodiscard]] std::string take() { return tape_.take(); }

 private:
  CanBus& bus_;
  std::ofstream log_;
  mutable CallTape tape_;
  mutable CanStatus told_{};
  Timestamp now_{};
};

class RecordingSerialPort final : public SerialPort {
 public:
  RecordingSerialPort(SerialPort& port, const RecordFolder& folder, const std::string& line);
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override;
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::uint32_t baud() const override { return port_.baud(); }
  [[nodiscard]] std::uint32_t lost() const override { return port_.lost(); }
  [[nodiscard]] std::string take() { return tape_.take(); }

 private:
  void note_baud();

  SerialPort& port_;
  std::uint32_t baud_ = 0;  ///< last written down
  std::ofstream raw_;
  std::ofstream stamps_;
  CallTape tape_;
};

/// The three ports and the list of cycles.
class Recorder {
 public:
  /// `settings`: text of the configuration file. Throws UserError (usage, device).
  Recorder(const std::string& folder, const std::string& settings, CanBus& can, SerialPort& lidar,
           SerialPort& imu);

  [[nodiscard]] CanBus& can() { return can_; }
  [[nodiscard]] SerialPort& lidar() { return lidar_; }
  [[nodiscard]] SerialPort& imu() { return imu_; }
  void start(Timestamp now);
  void begin_cycle(Timestamp now);
  void end_cycle();
  /// Closes the books. Throws UserError (device) when something could not be written.
  void finish(const DriveJournal& journal);

 private:
  RecordFolder folder_;
  RecordingCanBus can_;
  RecordingSerialPort lidar_;
  RecordingSerialPort imu_;
  std::ofstream cycles_;
  Timestamp now_{};
};

/// The result as text: what a replay must reproduce.
[[nodiscard]] std::string result_text(const DriveJournal& journal);

}  // namespace picolo::tool
