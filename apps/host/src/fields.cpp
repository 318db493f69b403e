// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "fields.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace picolo::host {
namespace {
constexpr std::string_view kSpace = " \t\v\f\r";
constexpr std::size_t kMostBeams = 100'000;
}  // namespace

bool parse_number(std::string_view text, double& value) {
  if (!text.empty() && text.front() == '+') { text.remove_prefix(1); }
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && stop == end && !text.empty();
}

Fields::Fields(std::string_view line) {
  std::size_t begin = line.find_first_not_of(kSpace);
  while (begin != std::string_view::npos) {
    const std::size_t end = line.find_first_of(kSpace, begin);
    fields_.push_back(line.substr(begin, end == std::string_view::npos ? end : end - begin));
    begin = end == std::string_view::npos ? end : line.find_first_not_of(kSpace, end);
  }
}

std::string_view Fields::text(std::size_t index) const {
  if (index >= fields_.size()) {
    throw BadLine{fmt::format("ends after {} of its fields", fields_.size())};
  }
  return fields_[index];
}

double Fields::number(std::size_t index, const char* what, bool any_value) const {
  double value = 0.0;
  if (!parse_number(text(index), value)) {
    throw BadLine{fmt::format("{} '{}' (field {}) is not a number", what,
                              fields_[index].substr(0, 24), index + 1)};
  }
  if (!any_value && !std::isfinite(value)) {
    throw BadLine{fmt::format("{} (field {}) is not finite", what, index + 1)};
  }
  return value;
}

std::size_t Fields::count(std::size_t index, const char* what) const {
  const std::string_view digits = text(index);
  std::size_t value = 0;
  const char* const end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc{} || stop != end || value > kMostBeams) {
    throw BadLine{fmt::format("{} '{}' (field {}) is not a count from 0 to {}", what,
                              digits.substr(0, 24), index + 1, kMostBeams)};
  }
  return value;
}

void Fields::expect_size(std::size_t expected, const char* what) const {
  if (fields_.size() != expected) {
    throw BadLine{
        fmt::format("{} needs {} fields, the line has {}", what, expected, fields_.size())};
  }
}

}  // namespace picolo::host
