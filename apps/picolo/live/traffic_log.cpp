// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/traffic_log.hpp"

#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"

namespace picolo::tool {

TrafficLog::TrafficLog(const std::string& folder) : folder_{folder} {
  host::make_folder(folder);
  can_.open(folder_.can(), std::ios::binary | std::ios::trunc);
  for (const char* name : {"lidar", "imu"}) {
    Line& line = lines_[name];
    line.raw.open(folder_.raw(name), std::ios::binary | std::ios::trunc);
    line.stamps.open(folder_.stamps(name), std::ios::binary | std::ios::trunc);
    line.stamps << "# microseconds of the last byte, bytes\n";
  }
  if (!can_) {
    throw host::UserError{host::ExitCode::usage, folder_.can().string(), "cannot be written",
                          "check the folder and its permissions"};
  }
}

void TrafficLog::can(const CanFrame& frame) {
  can_ << candump_line({frame, false});
}

void TrafficLog::serial(const std::string& line, std::span<const std::uint8_t> bytes,
                        Timestamp stamp) {
  Line& files = lines_[line];
  for (const std::uint8_t byte : bytes) { files.raw.put(static_cast<char>(byte)); }
  files.stamps << stamp.time_since_epoch().count() << ' ' << bytes.size() << '\n';
}

}  // namespace picolo::tool
