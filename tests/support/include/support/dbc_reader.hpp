// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A reader of DBC files of its own: knows the file's rules and nothing of the table.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace picolo::test {

struct DbcSignal {
  std::string name;
  int start = 0;
  int bits = 0;
  bool is_signed = false;
  double factor = 1.0;
  double offset = 0.0;
  double low = 0.0;
  double high = 0.0;
};
struct DbcMessage {
  std::string name;
  int length = 0;
  std::string sender;
  std::vector<DbcSignal> signals;
};
using Dbc = std::map<unsigned, DbcMessage>;

/// BO_ and SG_ lines, little-endian signals; a line that begins like one and is none is an error.
inline Dbc read_dbc(const std::string& text) {
  static const std::regex message{R"(BO_ (\d+) (\w+): (\d+) (\w+))"};
  static const std::regex signal{
      R"( SG_ (\w+) : (\d+)\|(\d+)@1([+-]) \(([^,]+),([^)]+)\) \[([^|]+)\|([^\]]+)\] "[^"]*" \w+)"};
  Dbc dbc;
  DbcMessage* current = nullptr;
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    std::smatch found;
    if (line.rfind("BO_ ", 0) == 0) {
      if (!std::regex_match(line, found, message)) { throw std::runtime_error{line}; }
      current = &dbc[static_cast<unsigned>(std::stoul(found[1]))];
      *current = {found[2], std::stoi(found[3]), found[4], {}};
    } else if (line.rfind(" SG_ ", 0) == 0) {
      if (current == nullptr || !std::regex_match(line, found, signal)) {
        throw std::runtime_error{line};
      }
      current->signals.push_back({found[1], std::stoi(found[2]), std::stoi(found[3]),
                                  found[4] == "-", std::stod(found[5]), std::stod(found[6]),
                                  std::stod(found[7]), std::stod(found[8])});
    }
  }
  return dbc;
}

/// Bit by bit, so that it shares nothing with the codec.
inline double dbc_value(const DbcSignal& signal, const std::array<std::uint8_t, 8>& data) {
  double raw = 0.0;
  double weight = 1.0;
  for (int i = 0; i < signal.bits; ++i) {
    const int bit = signal.start + i;
    const bool set = (data.at(static_cast<std::size_t>(bit / 8)) >> (bit % 8) & 1) != 0;
    const bool is_sign = signal.is_signed && i == signal.bits - 1;
    if (set) { raw += is_sign ? -weight : weight; }
    weight *= 2.0;
  }
  return raw * signal.factor + signal.offset;
}

}  // namespace picolo::test
