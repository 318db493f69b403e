// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/scip/scip_text.hpp"

#include <array>

#include "picolo/core/crc.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kEchoSize = 12;        // GDaaaabbbbcc
constexpr std::size_t kContinuousEcho = 15;  // MDaaaabbbbccsnn
constexpr std::size_t kMaxDigits = 9;

std::uint32_t fourcc(ByteView text) {
  return load_u32_be(text, 0);
}

constexpr std::uint32_t key(const char (&text)[5]) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value = (value << 8U) | static_cast<std::uint8_t>(text[i]);
  }
  return value;
}

}  // namespace

std::uint8_t scip_sum(ByteView text) {
  return static_cast<std::uint8_t>((sum8(text) & 0x3FU) + 0x30U);
}

Result<std::uint32_t> scip_decimal(ByteView text) {
  if (text.empty() || text.size() > kMaxDigits) { return Status::corrupt; }
  std::uint32_t value = 0;
  for (const std::uint8_t c : text) {
    if (c < '0' || c > '9') { return Status::corrupt; }
    value = value * 10 + (c - std::uint32_t{'0'});
  }
  return value;
}

namespace {

Result<ScipCommand> parse_echo_at_begin(ByteView line) {
  if (line.size() < kEchoSize) { return Status::corrupt; }
  ScipCommand command;
  command.continuous = line[0] == 'M';
  if (!command.continuous && line[0] != 'G') { return Status::corrupt; }
  if (command.continuous && line.size() < kContinuousEcho) { return Status::corrupt; }
  switch (line[1]) {
    case 'S': command.value_size = 2; break;
    case 'D': command.value_size = 3; break;
    case 'E': command.value_size = 6; break;
    default: return Status::corrupt;
  }
  const Result<std::uint32_t> first = scip_decimal(line.subspan(2, 4));
  const Result<std::uint32_t> last = scip_decimal(line.subspan(6, 4));
  const Result<std::uint32_t> cluster = scip_decimal(line.subspan(10, 2));
  if (!first || !last || !cluster || *first > *last) { return Status::corrupt; }
  if (command.continuous && !scip_decimal(line.subspan(12, 3))) { return Status::corrupt; }
  command.first_step = static_cast<std::uint16_t>(*first);
  command.last_step = static_cast<std::uint16_t>(*last);
  command.cluster = static_cast<std::uint8_t>(*cluster == 0 ? 1 : *cluster);
  return command;
}

}  // namespace

Result<ScipCommand> parse_scip_echo(ByteView line) {
  const Result<ScipCommand> command = parse_echo_at_begin(line);
  if (command) { return command; }
  for (const std::size_t size : {kContinuousEcho, kEchoSize}) {
    if (line.size() <= size) { continue; }
    const Result<ScipCommand> at_end = parse_echo_at_begin(line.last(size));
    if (at_end) { return at_end; }
  }
  return Status::corrupt;
}

bool is_scip_answer(ByteView line) {
  if (line.size() < 3) { return false; }
  // The sum covers what stands in front of the semicolon.
  const std::size_t behind = line[line.size() - 2] == ';' ? 2 : 1;
  return (behind == 2 || line.size() == 3) &&
         scip_sum(line.first(line.size() - behind)) == line[line.size() - 1];
}

bool read_scip_parameter(ByteView line, ScipModel& model) {
  // KEYW:digits;s
  if (line.size() < 8 || line[4] != ':' || line[line.size() - 2] != ';') { return false; }
  if (!is_scip_answer(line)) { return false; }
  const Result<std::uint32_t> number = scip_decimal(line.subspan(5, line.size() - 7));
  if (!number) { return false; }
  ScipModel changed = model;
  switch (fourcc(line)) {
    case key("ARES"): changed.steps_per_turn = *number; break;
    case key("AMIN"): changed.first_step = *number; break;
    case key("AMAX"): changed.last_step = *number; break;
    case key("AFRT"): changed.front_step = *number; break;
    case key("DMIN"): changed.min_mm = *number; break;
    case key("DMAX"): changed.max_mm = *number; break;
    case key("SCAN"): changed.turns_per_minute = *number; break;
    default: return false;
  }
  model = changed;
  return true;
}

}  // namespace picolo::inline v0
