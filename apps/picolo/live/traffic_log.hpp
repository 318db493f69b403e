// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A recording from the other end: traffic without cycles.
#pragma once

#include <cstdint>
#include <fstream>
#include <map>
#include <span>
#include <string>

#include "live/record_folder.hpp"

namespace picolo::tool {

class TrafficLog {
 public:
  /// Throws UserError (usage).
  explicit TrafficLog(const std::string& folder);

  void can(const CanFrame& frame);
  void serial(const std::string& line, std::span<const std::uint8_t> bytes, Timestamp stamp);

 private:
  struct Line {
    std::ofstream raw;
    std::ofstream stamps;
  };
  RecordFolder folder_;
  std::ofstream can_;
  std::map<std::string, Line> lines_;
};

}  // namespace picolo::tool
