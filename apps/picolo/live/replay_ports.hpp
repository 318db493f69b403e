// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Ports that answer as a recording says.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <fstream>
#include <string>
#include <vector>

#include "live/record_folder.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/serial_port.hpp"

namespace picolo::tool {

/// The answers of one cycle, taken letter by letter.
class AnswerTape {
 public:
  void load(const std::string& codes);
  /// The next letter; 0 when the controller asks more often than it did.
  char next();
  [[nodiscard]] char peek() const { return at_ < codes_.size() ? codes_[at_] : '\0'; }
  /// Reads "12;" or "1,2,3;" behind a letter.
  std::vector<std::uint32_t> numbers();
  [[nodiscard]] bool used_up() const { return at_ == codes_.size(); }

 private:
  std::string codes_;
  std::size_t at_ = 0;
};

/// Frames of can.log. What is sent is compared with what was sent then.
class ReplayCanBus final : public CanBus {
 public:
  explicit ReplayCanBus(const std::filesystem::path& log);
  void load(const std::string& codes) { tape_.load(codes); }
  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override;
  [[nodiscard]] CanStatus status() const override;
  /// Calls that differed from the recording.
  [[nodiscard]] std::size_t differences() const { return differences_; }
  [[nodiscard]] bool used_up() const { return tape_.used_up(); }

 private:
  std::deque<CanFrame> received_;
  std::deque<CanFrame> sent_;
  mutable AnswerTape tape_;
  mutable CanStatus status_{};
  std::size_t differences_ = 0;
};

/// Bytes of LINE.raw in the chunks of LINE.stamps. `baud` is used where the file names none.
class ReplaySerialPort final : public SerialPort {
 public:
  ReplaySerialPort(const RecordFolder& folder, const std::string& line, std::uint32_t baud);
  void load(const std::string& codes) { tape_.load(codes); }
  Result<SerialRead> read(std::span<std::uint8_t> buffer) override;
  Result<std::size_t> write(std::span<const std::uint8_t> bytes) override;
  [[nodiscard]] std::uint32_t baud() const override { return baud_; }
  [[nodiscard]] std::uint32_t lost() const override { return 0; }
  [[nodiscard]] std::size_t differences() const { return differences_; }
  [[nodiscard]] bool used_up() const { return tape_.used_up(); }

 private:
  std::uint32_t next_baud(std::uint32_t otherwise);

  std::ifstream raw_;
  std::ifstream stamps_;
  std::uint32_t baud_;
  AnswerTape tape_;
  std::size_t differences_ = 0;
};

}  // namespace picolo::tool
