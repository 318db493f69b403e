// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/recorder.hpp"

#include <fmt/format.h>

#include <utility>

#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"

namespace picolo::tool {
namespace {

std::ofstream create(const std::filesystem::path& path) {
  std::ofstream file{path, std::ios::binary | std::ios::trunc};
  if (!file) {
    throw host::UserError{host::ExitCode::usage, path.string(), "cannot be written",
                          "check the folder and its permissions"};
  }
  return file;
}

RecordFolder made(const std::string& folder) {
  host::make_folder(folder);
  return {folder};
}

bool same(const CanStatus& a, const CanStatus& b) {
  return a.rx_lost == b.rx_lost && a.error_frames == b.error_frames && a.restarts == b.restarts;
}

}  // namespace

std::string CallTape::take() {
  if (text_.empty()) { return "."; }
  return std::exchange(text_, {});
}

char code_of(Status status) {
  for (const char code : {'o', '-', 'f', 'x', 'i'}) {
    if (status_of(code) == status) { return code; }
  }
  return 'e';
}

Status status_of(char code) {
  switch (code) {
    case 'o': return Status::ok;
    case '-': return Status::not_ready;
    case 'f': return Status::full;
    case 'x': return Status::disconnected;
    case 'i': return Status::invalid_argument;
    default: return Status::io_error;
  }
}

char code_of(StampSource source) {
  switch (source) {
    case StampSource::hardware: return 'H';
    case StampSource::kernel: return 'K';
    case StampSource::read: return 'R';
    case StampSource::device: return 'D';
  }
  return 'R';
}

bool source_of(char code, StampSource& source) {
  for (const StampSource candidate :
       {StampSource::hardware, StampSource::kernel, StampSource::read, StampSource::device}) {
    if (code_of(candidate) != code) { continue; }
    source = candidate;
    return true;
  }
  return false;
}

RecordingCanBus::RecordingCanBus(CanBus& bus, const std::filesystem::path& log)
    : bus_(bus), log_(create(log)) {}

Result<CanFrame> RecordingCanBus::receive() {
  const Result<CanFrame> frame = bus_.receive();
  tape_.add(frame ? code_of((*frame).source) : code_of(frame.status()));
  if (frame) { log_ << candump_line({*frame, false}); }
  return frame;
}

Status RecordingCanBus::transmit(const CanFrame& frame) {
  const Status status = bus_.transmit(frame);
  tape_.add(code_of(status));
  if (is_ok(status)) {
    CanFrame sent = frame;
    sent.stamp = now_;
    log_ << candump_line({sent, true});
  }
  return status;
}

CanStatus RecordingCanBus::status() const {
  const CanStatus status = bus_.status();
  if (!same(status, told_)) {
    tape_.add(fmt::format("s{},{},{};", status.rx_lost, status.error_frames, status.restarts));
    told_ = status;
  }
  return status;
}

RecordingSerialPort::RecordingSerialPort(SerialPort& port, const RecordFolder& folder,
                                         const std::string& line)
    : port_(port), raw_(create(folder.raw(line))), stamps_(create(folder.stamps(line))) {
  note_baud();
}

void RecordingSerialPort::note_baud() {
  if (baud_ == port_.baud()) { return; }
  if (baud_ != 0) { tape_.add(fmt::format("b{};", port_.baud())); }
  baud_ = port_.baud();
  stamps_ << "# " << baud_ << " baud; microseconds of the last byte, bytes\n";
}

Result<SerialRead> RecordingSerialPort::read(std::span<std::uint8_t> buffer) {
  note_baud();
  const Result<SerialRead> read = port_.read(buffer);
  tape_.add(read ? code_of((*read).source) : code_of(read.status()));
  if (read) {
    for (const std::uint8_t byte : buffer.first((*read).size)) {
      raw_.put(static_cast<char>(byte));
    }
    stamps_ << (*read).last_byte_stamp.time_since_epoch().count() << ' ' << (*read).size << '\n';
  }
  return read;
}

Result<std::size_t> RecordingSerialPort::write(std::span<const std::uint8_t> bytes) {
  const Result<std::size_t> written = port_.write(bytes);
  if (written) {
    tape_.add(fmt::format("w{};", *written));
  } else {
    tape_.add(code_of(written.status()));
  }
  return written;
}

Recorder::Recorder(const std::string& folder, const std::string& settings, CanBus& can,
                   SerialPort& lidar, SerialPort& imu)
    : folder_(made(folder)),
      can_(can, folder_.can()),
      lidar_(lidar, folder_, "lidar"),
      imu_(imu, folder_, "imu"),
      cycles_(create(folder_.cycles())) {
  host::write_file(folder_.config(), settings);
}

void Recorder::start(Timestamp now) {
  can_.latch(now);
  cycles_ << "# picolo cycles 1: microseconds, then the answers of CAN bus, lidar and IMU\n"
          << "start " << now.time_since_epoch().count() << '\n';
}

void Recorder::begin_cycle(Timestamp now) {
  now_ = now;
  can_.latch(now);
}

void Recorder::end_cycle() {
  cycles_ << now_.time_since_epoch().count() << ' ' << can_.take() << ' ' << lidar_.take() << ' '
          << imu_.take() << '\n';
}

std::string result_text(const DriveJournal& journal) {
  host::Json json;
  json["cycles"] = journal.cycles();
  json["pose_hash"] = journal.hash();
  json["changes"] = journal.changes_json();
  return host::to_text(json) + "\n";
}

void Recorder::finish(const DriveJournal& journal) {
  write_tum(folder_.trajectory(), journal.trajectory());
  host::write_file(folder_.result(), result_text(journal));
  cycles_.flush();
  if (!cycles_) {
    throw host::UserError{host::ExitCode::device, folder_.path.string(),
                          "the recording could not be written to its end", "is the disk full?"};
  }
}

}  // namespace picolo::tool
