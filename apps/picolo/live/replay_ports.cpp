// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/replay_ports.hpp"

#include <sstream>

#include "live/recorder.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

std::ifstream open(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  if (!file) {
    throw host::UserError{host::ExitCode::input, path.string(), "cannot be opened",
                          "a recording is a folder with all of its files"};
  }
  return file;
}

bool same_frame(const CanFrame& a, const CanFrame& b) {
  return a.id == b.id && a.extended == b.extended && a.remote == b.remote && a.length == b.length &&
         a.data == b.data;
}

}  // namespace

void AnswerTape::load(const std::string& codes) {
  codes_ = codes == "." ? std::string{} : codes;
  at_ = 0;
}

char AnswerTape::next() {
  if (at_ >= codes_.size()) { return '\0'; }
  return codes_[at_++];
}

std::vector<std::uint32_t> AnswerTape::numbers() {
  std::vector<std::uint32_t> numbers{0};
  for (char c = next(); c != ';' && c != '\0'; c = next()) {
    if (c == ',') {
      numbers.push_back(0);
    } else {
      numbers.back() = numbers.back() * 10 + static_cast<std::uint32_t>(c - '0');
    }
  }
  return numbers;
}

ReplayCanBus::ReplayCanBus(const std::filesystem::path& log) {
  std::ifstream file = open(log);
  std::size_t number = 0;
  for (std::string text; std::getline(file, text);) {
    ++number;
    const Result<CandumpLine> line = parse_candump(text);
    if (!line) {
      throw host::UserError{host::ExitCode::input, log.string() + ":" + std::to_string(number),
                            "no line of a candump log", "get a whole copy of the recording"};
    }
    ((*line).sent ? sent_ : received_).push_back((*line).frame);
  }
}

Result<CanFrame> ReplayCanBus::receive() {
  const char code = tape_.next();
  StampSource source{};
  if (source_of(code, source) && !received_.empty()) {
    CanFrame frame = received_.front();
    received_.pop_front();
    frame.source = source;
    return frame;
  }
  if (code == '\0') { ++differences_; }
  return code == '\0' ? Status::not_ready : status_of(code);
}

Status ReplayCanBus::transmit(const CanFrame& frame) {
  const char code = tape_.next();
  const Status status = code == '\0' ? Status::full : status_of(code);
  if (code == '\0') { ++differences_; }
  if (status != Status::ok) { return status; }
  CanFrame padded = frame;
  for (std::size_t i = frame.length; i < padded.data.size(); ++i) { padded.data[i] = 0; }
  if (sent_.empty() || !same_frame(sent_.front(), padded)) { ++differences_; }
  if (!sent_.empty()) { sent_.pop_front(); }
  return status;
}

CanStatus ReplayCanBus::status() const {
  if (tape_.peek() == 's') {
    static_cast<void>(tape_.next());
    const std::vector<std::uint32_t> numbers = tape_.numbers();
    if (numbers.size() == 3) {
      status_.rx_lost = numbers[0];
      status_.error_frames = numbers[1];
      status_.restarts = numbers[2];
    }
  }
  return status_;
}

ReplaySerialPort::ReplaySerialPort(const RecordFolder& folder, const std::string& line,
                                   std::uint32_t baud)
    : raw_(open(folder.raw(line))), stamps_(open(folder.stamps(line))), baud_(baud) {
  baud_ = next_baud(baud);
}

/// Reads "# BAUD baud; ..." where the rate was set.
std::uint32_t ReplaySerialPort::next_baud(std::uint32_t otherwise) {
  std::string heading;
  std::getline(stamps_ >> std::ws, heading);
  return baud_of(heading).value_or(otherwise);
}

Result<SerialRead> ReplaySerialPort::read(std::span<std::uint8_t> buffer) {
  if (tape_.peek() == 'b') {
    static_cast<void>(tape_.next());
    baud_ = next_baud(tape_.numbers().front());
  }
  const char code = tape_.next();
  StampSource source{};
  if (!source_of(code, source)) {
    if (code == '\0') { ++differences_; }
    return code == '\0' ? Status::not_ready : status_of(code);
  }
  std::int64_t stamp_us = 0;
  std::size_t size = 0;
  if (!(stamps_ >> stamp_us >> size) || size > buffer.size()) {
    ++differences_;
    return Status::not_ready;
  }
  for (std::size_t i = 0; i < size; ++i) {
    buffer[i] = static_cast<std::uint8_t>(raw_.get() & 0xFF);
  }
  if (!raw_) { ++differences_; }
  return SerialRead{
      .size = size, .last_byte_stamp = Timestamp{Duration{stamp_us}}, .source = source};
}

Result<std::size_t> ReplaySerialPort::write(std::span<const std::uint8_t> /*bytes*/) {
  const char code = tape_.next();
  if (code == 'w') { return std::size_t{tape_.numbers().front()}; }
  if (code == '\0') { ++differences_; }
  return code == '\0' ? Status::full : status_of(code);
}

}  // namespace picolo::tool
