// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Every protocol that `picolo decode` knows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "decode/table.hpp"
#include "picolo/drivers/common/serial_counters.hpp"

namespace picolo::tool {

struct DecodeOptions {
  TableFormat format = TableFormat::csv;
  std::string mode;  ///< rplidar: standard, express, ultra, dense
};

/// What came of it.
struct DecodeResult {
  std::size_t samples = 0;
  SerialCounters counters{};  ///< of serial devices
  std::size_t frames = 0;     ///< CAN frames read
  std::size_t bad_lines = 0;  ///< of a candump log
};

struct SerialDecoder {
  std::string name;
  DecodeResult (*decode)(std::span<const std::uint8_t> bytes, const DecodeOptions& options);
};
[[nodiscard]] const std::vector<SerialDecoder>& serial_decoders();

struct CanDecoder {
  std::string name;
  DecodeResult (*decode)(std::istream& log, const DecodeOptions& options);
};
[[nodiscard]] const std::vector<CanDecoder>& can_decoders();
/// dbc:FILE. Throws host::UserError when the file is none.
[[nodiscard]] DecodeResult decode_dbc(const std::string& dbc_file, std::istream& log,
                                      const DecodeOptions& options);

}  // namespace picolo::tool
