// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/arrival_ports.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>

#include "picolo/controller/can_table.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"

namespace picolo::tool {
namespace {

namespace fs = std::filesystem;
using host::ExitCode;
using host::UserError;

constexpr std::size_t kSpreadBytes = 47;  // a chunk of captures without stamps

fs::path can_log_of(const RecordFolder& folder) {
  if (fs::exists(folder.can())) { return folder.can(); }
  std::vector<fs::path> logs;
  for (const auto& entry : fs::directory_iterator{folder.path}) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("candump", 0) == 0 && entry.path().extension() == ".log") {
      logs.push_back(entry.path());
    }
  }
  if (logs.size() == 1) { return logs.front(); }
  throw UserError{ExitCode::input, folder.path.string(),
                  logs.empty() ? "holds no CAN log" : "holds several CAN logs",
                  "it needs one: can.log, or candump-*.log as candump -l writes it"};
}

std::vector<CanFrame> read_can(const fs::path& path, std::uint32_t own_id,
                               host::Diagnostics& diagnostics) {
  std::ifstream file{path};
  std::vector<CanFrame> frames;
  std::size_t number = 0;
  for (std::string text; std::getline(file, text);) {
    ++number;
    const Result<CandumpLine> line = parse_candump(text);
    if (line.status() == Status::unsupported) { continue; }  // CAN FD and error frames
    if (!line) {
      diagnostics.skipped_line(path.string(), number, "no line of a candump log");
      continue;
    }
    const CanFrame& frame = (*line).frame;
    const bool own = !frame.extended && frame.id >= own_id && frame.id < own_id + kCanOwnIds;
    if (!own) { frames.push_back(frame); }
  }
  diagnostics.end_of_file(path.string());
  if (frames.empty()) {
    throw UserError{ExitCode::input, path.string(), "holds no frame of a device",
                    "record the bus of the wheel encoders"};
  }
  std::stable_sort(frames.begin(), frames.end(),
                   [](const CanFrame& a, const CanFrame& b) { return a.stamp < b.stamp; });
  return frames;
}

void read_stamps(const fs::path& path, SerialCapture& capture) {
  std::ifstream file{path};
  std::size_t begin = 0;
  std::size_t number = 0;
  for (std::string text; std::getline(file, text);) {
    ++number;
    if (const auto baud = baud_of(text)) { capture.baud = baud; }
    if (text.empty() || text.front() == '#') { continue; }
    std::istringstream words{text};
    std::int64_t stamp_us = 0;
    std::size_t size = 0;
    if (!(words >> stamp_us >> size)) {
      throw UserError{ExitCode::input, fmt::format("{}:{}", path.string(), number),
                      "is not MICROSECONDS BYTES", "get a whole copy of the recording"};
    }
    size = std::min(size, capture.bytes.size() - begin);  // the last chunk may be torn
    const Timestamp stamp{Duration{stamp_us}};
    const bool falls = !capture.chunks.empty() && stamp < capture.chunks.back().stamp;
    capture.chunks.push_back({falls ? capture.chunks.back().stamp : stamp, begin, size});
    begin += size;
  }
}

void spread(SerialCapture& capture, Timestamp from, Timestamp to) {
  const std::size_t total = capture.bytes.size();
  for (std::size_t begin = 0; begin < total; begin += kSpreadBytes) {
    const std::size_t size = std::min(kSpreadBytes, total - begin);
    const std::int64_t span_us = (to - from).count();
    const auto share = static_cast<std::int64_t>(begin + size) * span_us;
    capture.chunks.push_back(
        {from + Duration{share / static_cast<std::int64_t>(total)}, begin, size});
  }
}

SerialCapture read_serial(const RecordFolder& folder, const std::string& line,
                          const std::vector<CanFrame>& can, host::Diagnostics& diagnostics) {
  SerialCapture capture;
  const std::string content = host::read_file(folder.raw(line));
  capture.bytes.assign(content.begin(), content.end());
  if (fs::exists(folder.stamps(line))) {
    read_stamps(folder.stamps(line), capture);
  } else {
    diagnostics.warn(folder.raw(line).string(), "has no .stamps beside it",
                     "its bytes are spread evenly over the time of the CAN log");
    spread(capture, can.front().stamp, can.back().stamp);
  }
  if (capture.chunks.empty()) { return capture; }
  const bool disjoint = capture.chunks.front().stamp > can.back().stamp ||
                        capture.chunks.back().stamp < can.front().stamp;
  if (disjoint) {
    diagnostics.warn(folder.stamps(line).string(), "runs on another clock than the CAN log",
                     "both are taken to begin at the same instant");
    const Duration shift = can.front().stamp - capture.chunks.front().stamp;
    for (SerialChunkRecord& chunk : capture.chunks) { chunk.stamp += shift; }
  }
  return capture;
}

}  // namespace

Captures read_captures(const RecordFolder& folder, std::uint32_t own_id,
                       host::Diagnostics& diagnostics) {
  Captures captures;
  captures.can = read_can(can_log_of(folder), own_id, diagnostics);
  captures.begin = captures.can.front().stamp;
  captures.end = captures.can.back().stamp;
  captures.lidar = read_serial(folder, "lidar", captures.can, diagnostics);
  if (fs::exists(folder.raw("imu"))) {
    captures.imu = read_serial(folder, "imu", captures.can, diagnostics);
  }
  const SerialCapture* imu = captures.imu ? &*captures.imu : nullptr;
  for (const SerialCapture* capture : std::array<const SerialCapture*, 2>{&captures.lidar, imu}) {
    if (capture == nullptr || capture->chunks.empty()) { continue; }
    captures.begin = std::min(captures.begin, capture->chunks.front().stamp);
    captures.end = std::max(captures.end, capture->chunks.back().stamp);
  }
  return captures;
}

Result<CanFrame> ArrivalCanBus::receive() {
  if (next_ >= frames_.size() || frames_[next_].stamp > clock_.now()) { return Status::not_ready; }
  return frames_[next_++];
}

Result<SerialRead> ArrivalSerialPort::read(std::span<std::uint8_t> buffer) {
  if (capture_ == nullptr) { return Status::disconnected; }
  while (chunk_ < capture_->chunks.size() && taken_ == capture_->chunks[chunk_].size) {
    ++chunk_;
    taken_ = 0;
  }
  if (chunk_ >= capture_->chunks.size() || capture_->chunks[chunk_].stamp > clock_.now() ||
      buffer.empty()) {
    return Status::not_ready;
  }
  const SerialChunkRecord& chunk = capture_->chunks[chunk_];
  const std::size_t size = std::min(buffer.size(), chunk.size - taken_);
  std::copy_n(capture_->bytes.begin() + static_cast<std::ptrdiff_t>(chunk.begin + taken_), size,
              buffer.begin());
  taken_ += size;
  return SerialRead{.size = size,
                    .last_byte_stamp = chunk.stamp - transmission_time(chunk.size - taken_, baud_),
                    .source = StampSource::read};
}

}  // namespace picolo::tool
