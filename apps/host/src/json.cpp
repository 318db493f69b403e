// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/json.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace picolo::host {
namespace {

void print(const Json& json, std::string& text) {
  if (json.is_number_float()) {
    text += plain_decimal(json.get<double>());
    return;
  }
  if (!json.is_structured()) {
    text += json.dump(-1, ' ', false, Json::error_handler_t::replace);
    return;
  }
  text += json.is_object() ? '{' : '[';
  bool first = true;
  for (const auto& [key, value] : json.items()) {
    if (!first) { text += ','; }
    first = false;
    if (json.is_object()) {
      text += Json(key).dump(-1, ' ', false, Json::error_handler_t::replace) + ':';
    }
    print(value, text);
  }
  text += json.is_object() ? '}' : ']';
}

}  // namespace

std::string plain_decimal(double value) {
  if (!std::isfinite(value)) { return "null"; }
  std::array<char, 1100> digits{};  // the smallest double has 1074 decimals
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  return error == std::errc{} ? std::string{digits.data(), end} : "null";
}

std::string to_text(const Json& json) {
  std::string text;
  print(json, text);
  return text;
}

}  // namespace picolo::host
