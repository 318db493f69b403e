// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The recorded byte vectors of shared/data/drivers and candump logs.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "picolo/hal/can_bus.hpp"
#include "support/bytes.hpp"
#include "support/data.hpp"

namespace picolo::test {

inline constexpr const char* kVectorFile = "drivers/vectors.jsonl";

struct ByteVector {
  std::string id;
  Bytes bytes;
  nlohmann::json expected;
};

/// All serial vectors whose protocol is `protocol`. After PICOLO_NEED_DATA(kVectorFile).
inline std::vector<ByteVector> byte_vectors(const std::string& protocol) {
  std::vector<ByteVector> vectors;
  std::ifstream file{data_path(kVectorFile)};
  for (std::string line; std::getline(file, line);) {
    const auto entry = nlohmann::json::parse(line);
    if (entry.at("protocol") != protocol) { continue; }
    vectors.push_back(
        {entry.at("id"), from_hex(entry.at("hex").get<std::string>()), entry.at("expected")});
  }
  return vectors;
}

/// "181#38420000" as candump writes it; `R` after the # is a remote frame; 8 digits of identifier
/// mean 29 bits.
inline CanFrame parse_can_frame(const std::string& text, Timestamp stamp = {}) {
  const std::size_t hash = text.find('#');
  if (hash == std::string::npos) { throw std::invalid_argument{"no # in CAN frame: " + text}; }
  CanFrame frame{.stamp = stamp,
                 .id = static_cast<std::uint32_t>(std::stoul(text.substr(0, hash), nullptr, 16))};
  frame.extended = hash == 8;
  frame.remote = text.size() > hash + 1 && text[hash + 1] == 'R';
  if (frame.remote) { return frame; }
  const Bytes data = from_hex(text.substr(hash + 1));
  if (data.size() > frame.data.size()) {
    throw std::invalid_argument{"more than 8 bytes in CAN frame: " + text};
  }
  frame.length = static_cast<std::uint8_t>(data.size());
  std::copy(data.begin(), data.end(), frame.data.begin());
  return frame;
}

/// Lines like "(0.001000) can0 181#3842"; stamps start one second after the epoch, so that none is
/// 0.
inline std::vector<CanFrame> read_candump(const std::filesystem::path& path) {
  std::vector<CanFrame> frames;
  std::ifstream file{path};
  std::string time;
  std::string interface;
  for (std::string frame; file >> time >> interface >> frame;) {
    const double seconds_s = std::stod(time.substr(1));
    frames.push_back(parse_can_frame(frame, Timestamp{1s} + from_seconds(seconds_s)));
  }
  return frames;
}

}  // namespace picolo::test
