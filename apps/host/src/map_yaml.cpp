// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "pgm_file.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/line_reader.hpp"
#include "picolo/host/map_file.hpp"

namespace picolo::host {
namespace {

struct Entry {
  std::string value;
  std::size_t line = 0;
};

std::string trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && is_space(text.front())) { text.remove_prefix(1); }
  while (!text.empty() && is_space(text.back())) { text.remove_suffix(1); }
  return std::string{text};
}

std::string without_comment(std::string_view line) {
  char quote = '\0';
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (quote != '\0') {
      if (c == quote) { quote = '\0'; }
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '#' && (k == 0 || line[k - 1] == ' ' || line[k - 1] == '\t')) {
      return trimmed(line.substr(0, k));
    }
  }
  return trimmed(line);
}

std::string unquoted(const std::string& text) {
  const bool quoted = text.size() >= 2 && (text.front() == '"' || text.front() == '\'') &&
                      text.front() == text.back();
  return quoted ? text.substr(1, text.size() - 2) : text;
}

/// What map_server's files consist of: "key: value" lines; a list in brackets or as "- x" lines.
class MapYaml {
 public:
  explicit MapYaml(const std::filesystem::path& path) : name_{path.string()} {
    LineReader reader{name_};
    std::string_view line;
    std::string last;
    while (reader.next(line)) {
      const std::string text = without_comment(line);
      if (text.empty() || text == "---" || text == "...") { continue; }
      if (text.starts_with("- ") && !last.empty()) {
        entries_[last].value += (entries_[last].value.empty() ? "" : ",") + text.substr(2);
        continue;
      }
      const std::size_t colon = text.find(':');
      if (colon == std::string::npos) {
        throw UserError{ExitCode::input, at(reader.line_number()), "is no 'key: value' line",
                        "give the YAML file that ROS's map_saver or picolo has written"};
      }
      last = trimmed(std::string_view{text}.substr(0, colon));
      entries_[last] = {trimmed(std::string_view{text}.substr(colon + 1)), reader.line_number()};
    }
  }

  [[nodiscard]] std::optional<std::string> word(const std::string& key) const {
    const auto found = entries_.find(key);
    if (found == entries_.end()) { return std::nullopt; }
    return unquoted(found->second.value);
  }
  [[nodiscard]] std::string needed_word(const std::string& key) const {
    const auto value = word(key);
    if (!value || value->empty()) {
      throw UserError{ExitCode::input, name_, "has no '" + key + "'",
                      "it must name image, resolution and origin"};
    }
    return *value;
  }
  [[nodiscard]] double number(const std::string& key, std::optional<double> otherwise) const {
    const auto value = otherwise ? word(key) : needed_word(key);
    return value ? parsed(*value, key) : *otherwise;
  }
  [[nodiscard]] bool truth(const std::string& key) const {
    const std::string value = word(key).value_or("0");
    if (value == "1" || value == "true" || value == "True") { return true; }
    if (value == "0" || value == "false" || value == "False") { return false; }
    refuse(key, "0 or 1");
  }
  [[nodiscard]] std::array<double, 3> origin() const {
    std::string text = needed_word("origin");
    if (text.front() == '[' && text.back() == ']') { text = text.substr(1, text.size() - 2); }
    std::array<double, 3> numbers{};
    std::size_t count = 0;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      if (count == numbers.size()) { refuse("origin", "[x, y, yaw]"); }
      numbers[count] = parsed(trimmed(std::string_view{text}.substr(begin, end - begin)), "origin");
      ++count;
      begin = end + 1;
    }
    if (count < 2) { refuse("origin", "[x, y, yaw]"); }
    return numbers;
  }
  [[noreturn]] void refuse(const std::string& key, const std::string& expected) const {
    const auto found = entries_.find(key);
    throw UserError{ExitCode::input, found == entries_.end() ? name_ : at(found->second.line),
                    "'" + key + "' cannot be used", "expected " + expected};
  }

 private:
  [[nodiscard]] std::string at(std::size_t line) const { return fmt::format("{}:{}", name_, line); }
  [[nodiscard]] double parsed(const std::string& text, const std::string& key) const {
    double value = 0.0;
    const char* const begin = text.data() + (text.starts_with("+") ? 1 : 0);
    const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
      refuse(key, "a number");
    }
    return value;
  }

  std::string name_;
  std::map<std::string, Entry> entries_;
};

enum class Mode { trinary, scale, raw };

Mode mode_of(const MapYaml& yaml) {
  const std::string mode = yaml.word("mode").value_or("trinary");
  if (mode == "trinary") { return Mode::trinary; }
  if (mode == "scale") { return Mode::scale; }
  if (mode == "raw") { return Mode::raw; }
  yaml.refuse("mode", "trinary, scale or raw");
}

}  // namespace

OccupancyImage read_map(const std::filesystem::path& yaml_path) {
  const MapYaml yaml{yaml_path};
  OccupancyImage map;
  map.resolution_m = yaml.number("resolution", std::nullopt);
  if (!(map.resolution_m > 0.0)) { yaml.refuse("resolution", "a positive number of metres"); }
  const auto [x_m, y_m, yaw_rad] = yaml.origin();
  if (yaw_rad != 0.0) { yaml.refuse("origin", "a yaw of 0: turn the picture instead"); }
  map.origin_x_m = x_m;
  map.origin_y_m = y_m;
  const Mode mode = mode_of(yaml);
  const bool negate = yaml.truth("negate");
  const double occupied_from = yaml.number("occupied_thresh", 0.65);
  const double free_below = yaml.number("free_thresh", 0.25);  // map_server's own default
  if (free_below > occupied_from) {
    yaml.refuse("free_thresh", "a number not above occupied_thresh");
  }
  std::filesystem::path image_path = yaml.needed_word("image");
  if (image_path.is_relative()) { image_path = yaml_path.parent_path() / image_path; }
  const GreyImage image = read_pgm(image_path);
  map.width = image.width;
  map.height = image.height;
  map.cells.assign(map.width * map.height, MapCell::unknown);
  const auto judged = [&](int grey) {
    double occupancy = static_cast<double>(grey) / image.white;
    if (mode == Mode::raw) {  // the grey is the occupancy in percent; above 100 means unknown
      if (grey > 100) { return MapCell::unknown; }
      occupancy = grey / 100.0;
    } else if (!negate) {
      occupancy = static_cast<double>(image.white - grey) / image.white;
    }
    if (occupancy > occupied_from) { return MapCell::occupied; }
    return occupancy < free_below ? MapCell::free : MapCell::unknown;
  };
  for (std::size_t row = 0; row < map.height; ++row) {
    for (std::size_t column = 0; column < map.width; ++column) {
      map.cells[(map.height - 1 - row) * map.width + column] =
          judged(image.greys[row * map.width + column]);
    }
  }
  return map;
}

}  // namespace picolo::host
