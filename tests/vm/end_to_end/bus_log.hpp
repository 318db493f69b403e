// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What candump heard, decoded by the DBC file alone.
#pragma once

#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include "picolo/geometry/pose2.hpp"
#include "picolo/localisation/pose_estimate.hpp"
#include "support/dbc_reader.hpp"

namespace picolo::test {

/// One published pose: the frames PicoloPose, PicoloHealth and PicoloTime with the same counter.
struct Report {
  double stamp_s = 0.0;
  Pose2d map_T_base{};
  HealthState state = HealthState::initialising;
  std::string line;  ///< of the log, that holds the pose
};

class BusLog {
 public:
  BusLog(const std::string& path, const Dbc& dbc) : dbc_(dbc) {
    std::ifstream file{path};
    for (std::string line; std::getline(file, line);) { take(line); }
  }
  [[nodiscard]] const std::vector<Report>& reports() const { return reports_; }
  [[nodiscard]] std::size_t frames() const { return frames_; }

 private:
  /// "(1436509052.249713) vcan0 110#0011223344556677"
  void take(const std::string& line) {
    const std::size_t name = line.find(") ");
    const std::size_t id = line.find(' ', name + 2);
    const std::size_t hash = line.find('#');
    if (name == std::string::npos || id == std::string::npos || hash == std::string::npos) {
      return;
    }
    ++frames_;
    const auto message = dbc_.find(
        static_cast<unsigned>(std::stoul(line.substr(id + 1, hash - id - 1), nullptr, 16)));
    if (message == dbc_.end() || line.size() - hash - 1 != 16) { return; }
    for (std::size_t i = 0; i < data_.size(); ++i) {
      data_[i] =
          static_cast<std::uint8_t>(std::stoul(line.substr(hash + 1 + 2 * i, 2), nullptr, 16));
    }
    decode(message->second, line);
  }
  void decode(const DbcMessage& message, const std::string& line) {
    const int counter = static_cast<int>(value(message, "counter"));
    if (message.name == "PicoloPose") {
      pending_ = {};
      pending_.line = line;
      pending_.map_T_base = {value(message, "x_m"), value(message, "y_m"),
                             value(message, "yaw_rad")};
      pose_counter_ = counter;
    }
    if (message.name == "PicoloHealth") {
      pending_.state = static_cast<HealthState>(static_cast<int>(value(message, "state")));
      health_counter_ = counter;
    }
    if (message.name == "PicoloTime" && pose_counter_ == counter && health_counter_ == counter) {
      pending_.stamp_s = 1e-6 * value(message, "stamp_us");
      reports_.push_back(pending_);
      pose_counter_ = -1;
    }
  }
  [[nodiscard]] double value(const DbcMessage& message, const std::string& signal) const {
    for (const DbcSignal& one : message.signals) {
      if (one.name == signal) { return dbc_value(one, data_); }
    }
    return std::nan("");
  }

  const Dbc& dbc_;
  std::array<std::uint8_t, 8> data_{};
  std::vector<Report> reports_;
  Report pending_;
  int pose_counter_ = -1;
  int health_counter_ = -1;
  std::size_t frames_ = 0;
};

}  // namespace picolo::test
