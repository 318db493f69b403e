// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/record_folder.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

namespace picolo::tool {
namespace {

constexpr std::int64_t kMicro = 1'000'000;

template <typename T>
bool number(std::string_view text, T& value, int base = 10) {
  const char* end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value, base);
  return !text.empty() && parsed.ec == std::errc{} && parsed.ptr == end;
}

std::string_view next_word(std::string_view& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) { return text = {}; }
  const std::size_t end = text.find_first_of(" \t\r", begin);
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end);
  return word;
}

bool parse_stamp(std::string_view word, Timestamp& stamp) {
  if (word.size() < 3 || word.front() != '(' || word.back() != ')') { return false; }
  word = word.substr(1, word.size() - 2);
  const std::size_t point = word.find('.');
  if (point == std::string_view::npos || word.size() - point != 7) { return false; }
  std::int64_t seconds = 0;
  std::int64_t micro = 0;
  if (!number(word.substr(0, point), seconds) || !number(word.substr(point + 1), micro)) {
    return false;
  }
  stamp = Timestamp{Duration{seconds * kMicro + micro}};
  return true;
}

Status parse_frame(std::string_view word, CanFrame& frame) {
  const std::size_t hash = word.find('#');
  if (hash == std::string_view::npos || !number(word.substr(0, hash), frame.id, 16)) {
    return Status::checksum;
  }
  frame.extended = hash == 8;
  std::string_view data = word.substr(hash + 1);
  if (!data.empty() && data.front() == '#') { return Status::unsupported; }
  if (frame.id > (frame.extended ? 0x1FFF'FFFFU : 0x7FFU)) { return Status::unsupported; }
  if (!data.empty() && data.front() == 'R') {
    frame.remote = true;
    std::uint8_t length = 0;
    if (data.size() > 1 && !number(data.substr(1, 1), length)) { return Status::checksum; }
    frame.length = length;
    return length <= 8 ? Status::ok : Status::checksum;
  }
  if (data.size() > 16 || data.size() % 2 != 0) { return Status::checksum; }
  for (std::size_t i = 0; i < data.size(); i += 2) {
    if (!number(data.substr(i, 2), frame.data[i / 2], 16)) { return Status::checksum; }
  }
  frame.length = static_cast<std::uint8_t>(data.size() / 2);
  return Status::ok;
}

}  // namespace

std::optional<std::uint32_t> baud_of(const std::string& heading) {
  std::string_view rest = heading;
  std::uint32_t baud = 0;
  const bool found = next_word(rest) == "#" && number(next_word(rest), baud) && baud > 0 &&
                     next_word(rest).rfind("baud", 0) == 0;
  if (!found) { return std::nullopt; }
  return baud;
}

std::string candump_line(const CandumpLine& line) {
  const CanFrame& frame = line.frame;
  const std::int64_t stamp = frame.stamp.time_since_epoch().count();
  std::string text = fmt::format("({:010d}.{:06d}) can0 ", stamp / kMicro, stamp % kMicro);
  text += frame.extended ? fmt::format("{:08X}#", frame.id) : fmt::format("{:03X}#", frame.id);
  if (frame.remote) { text += frame.length == 0 ? "R" : fmt::format("R{}", frame.length); }
  for (std::size_t i = 0; !frame.remote && i < frame.length; ++i) {
    text += fmt::format("{:02X}", frame.data[i]);
  }
  return text + (line.sent ? " T\n" : "\n");
}

Result<CandumpLine> parse_candump(const std::string& text) {
  std::string_view rest = text;
  CandumpLine line;
  if (!parse_stamp(next_word(rest), line.frame.stamp)) { return Status::checksum; }
  static_cast<void>(next_word(rest));  // the interface
  const Status status = parse_frame(next_word(rest), line.frame);
  if (status != Status::ok) { return status; }
  line.sent = next_word(rest) == "T";
  line.frame.source = StampSource::kernel;
  return line;
}

}  // namespace picolo::tool
