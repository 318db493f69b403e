// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The files of a recorded drive; docs/recording.md describes them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "picolo/core/result.hpp"
#include "picolo/hal/can_bus.hpp"

namespace picolo::tool {

struct RecordFolder {
  std::filesystem::path path;

  [[nodiscard]] std::filesystem::path config() const { return path / "config.toml"; }
  [[nodiscard]] std::filesystem::path can() const { return path / "can.log"; }
  [[nodiscard]] std::filesystem::path cycles() const { return path / "cycles.log"; }
  [[nodiscard]] std::filesystem::path store() const { return path / "store.bin"; }
  [[nodiscard]] std::filesystem::path result() const { return path / "result.json"; }
  [[nodiscard]] std::filesystem::path trajectory() const { return path / "trajectory.tum"; }
  [[nodiscard]] std::filesystem::path raw(const std::string& line) const {
    return path / (line + ".raw");
  }
  [[nodiscard]] std::filesystem::path stamps(const std::string& line) const {
    return path / (line + ".stamps");
  }
};

/// The rate in "# BAUD baud; ...", as LINE.stamps begins and goes on where the rate changed.
[[nodiscard]] std::optional<std::uint32_t> baud_of(const std::string& heading);

/// A line of a candump log: "(SECONDS.MICROSECONDS) INTERFACE ID#DATA", for sent frames with " T"
/// behind it.
struct CandumpLine {
  CanFrame frame{};
  bool sent = false;
};
[[nodiscard]] std::string candump_line(const CandumpLine& line);
/// `checksum`: no such line. `unsupported`: a CAN FD or an error frame.
[[nodiscard]] Result<CandumpLine> parse_candump(const std::string& text);

}  // namespace picolo::tool
