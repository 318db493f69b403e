// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/devices/candump.hpp"

#include <charconv>
#include <vector>

namespace picolo::inline v0::devices {
namespace {

constexpr std::uint32_t kErrorFlag = 0x20000000U;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  while (true) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string_view::npos) { return words; }
    line.remove_prefix(begin);
    const std::size_t end = std::min(line.find_first_of(" \t\r"), line.size());
    words.push_back(line.substr(0, end));
    line.remove_prefix(end);
  }
}

template <typename T>
bool whole_number(std::string_view text, T& value, int base) {
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value, base);
  return result.ec == std::errc{} && result.ptr == text.data() + text.size();
}

bool read_stamp(std::string_view word, Timestamp& stamp) {
  if (word.size() < 3 || word.front() != '(' || word.back() != ')') { return false; }
  word = word.substr(1, word.size() - 2);
  const std::size_t point = std::min(word.find('.'), word.size());
  std::int64_t seconds = 0;
  if (!whole_number(word.substr(0, point), seconds, 10) || seconds < 0 ||
      seconds > 100'000'000'000) {
    return false;
  }
  std::string_view digits = word.substr(std::min(point + 1, word.size()));
  std::int64_t micros = 0;
  std::int64_t scale = 100'000;
  for (const char c : digits.substr(0, 6)) {
    if (c < '0' || c > '9') { return false; }
    micros += (c - '0') * scale;
    scale /= 10;
  }
  stamp = Timestamp{Duration{seconds * 1'000'000 + micros}};
  return true;
}

bool read_id(std::string_view text, CanFrame& frame) {
  if (text.empty() || text.size() > 8 || !whole_number(text, frame.id, 16)) { return false; }
  frame.extended = text.size() > 3;
  return (frame.id & kErrorFlag) == 0 && frame.id <= (frame.extended ? 0x1FFFFFFFU : 0x7FFU);
}

bool add_byte(std::string_view text, CanFrame& frame) {
  if (frame.length >= frame.data.size() || text.size() != 2 ||
      !whole_number(text, frame.data[frame.length], 16)) {
    return false;
  }
  ++frame.length;
  return true;
}

bool read_compact(std::string_view word, CanFrame& frame) {
  const std::size_t hash = word.find('#');
  if (hash == std::string_view::npos || !read_id(word.substr(0, hash), frame)) { return false; }
  std::string_view data = word.substr(hash + 1);
  if (!data.empty() && data.front() == '#') { return false; }  // CAN FD
  if (!data.empty() && (data.front() == 'R' || data.front() == 'r')) {
    frame.remote = true;
    return true;
  }
  for (; !data.empty(); data.remove_prefix(std::min<std::size_t>(2, data.size()))) {
    if (data.front() == '.') {
      data.remove_prefix(1);
      if (data.empty()) { break; }
    }
    if (!add_byte(data.substr(0, 2), frame)) { return false; }
  }
  return true;
}

bool read_spread(const std::vector<std::string_view>& words, std::size_t bracket, CanFrame& frame) {
  std::size_t length = 0;
  const std::string_view count = words[bracket];
  if (bracket == 0 || count.size() < 3 || count.back() != ']' ||
      !whole_number(count.substr(1, count.size() - 2), length, 10) || length > 8 ||
      !read_id(words[bracket - 1], frame)) {
    return false;
  }
  if (bracket + 1 < words.size() && words[bracket + 1] == "remote") {
    frame.remote = true;
    return true;
  }
  if (words.size() < bracket + 1 + length) { return false; }
  for (std::size_t i = 0; i < length; ++i) {
    if (!add_byte(words[bracket + 1 + i], frame)) { return false; }
  }
  return true;
}

}  // namespace

std::optional<CanFrame> parse_candump(std::string_view line) {
  const std::vector<std::string_view> words = words_of(line);
  CanFrame frame;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i].front() == '(' && !read_stamp(words[i], frame.stamp)) { return std::nullopt; }
    if (words[i].front() == '[') {
      return read_spread(words, i, frame) ? std::optional{frame} : std::nullopt;
    }
    if (words[i].find('#') != std::string_view::npos) {
      return read_compact(words[i], frame) ? std::optional{frame} : std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace picolo::inline v0::devices
