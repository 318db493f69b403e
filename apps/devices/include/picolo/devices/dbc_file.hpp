// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Reads a CAN database (DBC) into the tables that drivers/dbc decodes by.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "picolo/core/bytes.hpp"
#include "picolo/core/result.hpp"
#include "picolo/drivers/dbc/dbc_wheels.hpp"

namespace picolo::inline v0::devices {

struct DbcFileSignal {
  std::string name{};
  DbcSignal bits{};
  double factor = 1.0;
  double offset = 0.0;
  std::string unit{};
  bool is_selector = false;     ///< M
  bool is_multiplexed = false;  ///< m: only there while the selector has mux_value
  std::uint64_t mux_value = 0;
  std::size_t line = 0;
  std::string problem{};  ///< why it cannot be decoded; empty when it can
};

struct DbcFileMessage {
  std::uint32_t id = 0;
  bool extended = false;
  std::string name{};
  std::size_t frame_bytes = 0;
  std::vector<DbcFileSignal> signals{};
  [[nodiscard]] const DbcFileSignal* selector() const;
};

struct DbcFile {
  std::string name{};
  std::vector<DbcFileMessage> messages{};
  /// "file:line: cause; cure", one for each thing that was left out.
  std::vector<std::string> problems{};
  [[nodiscard]] const DbcFileMessage* find(std::uint32_t id, bool extended) const;
};

/// Never throws: what cannot be understood is a problem of the result. `imports`: file names that
/// the text asks to include (opendbc's convention).
[[nodiscard]] DbcFile parse_dbc(std::string_view text, const std::string& name,
                                std::vector<std::string>* imports = nullptr);
/// Reads a file and what it imports from its own folder. Throws std::invalid_argument when a file
/// cannot be read or holds no message.
[[nodiscard]] DbcFile read_dbc(const std::string& path);

/// The value in the signal's unit. `out_of_range`: not in this frame (too short, or multiplexed
/// away); `unsupported`: the signal has a problem.
[[nodiscard]] Result<double> dbc_value(const DbcFileMessage& message, const DbcFileSignal& signal,
                                       ByteView data);

/// A wheel from "MESSAGE.SIGNAL". Throws std::invalid_argument, naming file and line, when there is
/// none or when it lies past its frame.
[[nodiscard]] DbcWheelConfig dbc_wheel(const DbcFile& file, const std::string& signal);

}  // namespace picolo::inline v0::devices
