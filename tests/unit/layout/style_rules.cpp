// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "style_rules.hpp"

#include <regex>
#include <string>

namespace picolo::layout {
namespace {

constexpr std::size_t kMaxLines = 400;
constexpr std::size_t kMaxColumns = 100;

/// UTF-8 continuation bytes take no column.
std::size_t columns(const std::string& line) {
  std::size_t count = 0;
  for (const char c : line) { count += (static_cast<unsigned char>(c) & 0xC0U) != 0x80U ? 1U : 0U; }
  return count;
}

std::vector<Violation> check_licence(const SourceFile& file, const std::string& comment,
                                     std::size_t first) {
  const bool present =
      file.lines.size() >= first + 2 &&
      file.lines[first] == comment + " SPDX-FileCopyrightText: picolo contributors" &&
      file.lines[first + 1] == comment + " SPDX-License-Identifier: Apache-2.0";
  if (present) { return {}; }
  return {{file.path, static_cast<int>(first) + 1, "the two SPDX lines are missing"}};
}

}  // namespace

std::vector<Violation> form_violations(const SourceFile& file) {
  std::vector<Violation> violations = check_licence(file, "//", 0);
  if (file.lines.size() > kMaxLines) {
    violations.push_back({file.path, static_cast<int>(kMaxLines), "more than 400 lines"});
  }
  bool pragma_once = false;
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    pragma_once = pragma_once || file.lines[i] == "#pragma once";
    if (columns(file.lines[i]) > kMaxColumns) {
      violations.push_back({file.path, static_cast<int>(i) + 1, "more than 100 columns"});
    }
  }
  if (is_header(file) && !pragma_once) {
    violations.push_back({file.path, 1, "#pragma once is missing"});
  }
  return violations;
}

std::vector<Violation> licence_violations(const SourceFile& file) {
  std::size_t first = 0;
  while (first < file.lines.size() && (file.lines[first].rfind("#!", 0) == 0 ||
                                       file.lines[first].rfind("# shellcheck", 0) == 0)) {
    ++first;
  }
  return check_licence(file, "#", first);
}

std::vector<Violation> poisoned_names(const SourceFile& file) {
  static const std::regex poisoned{
      R"re(\b(?:new|delete|malloc|calloc|realloc|free|throw|try|catch|dynamic_cast|typeid)\b)re"
      R"re(|\b(?:printf|snprintf|sprintf|fprintf|rand|srand|abort|goto|setjmp|longjmp)\b)re"
      R"re(|\b(?:Dynamic|MatrixXd|MatrixXf|VectorXd|VectorXf)\b)re"
      R"re(|\b(?:reinterpret_cast|thread_local|volatile)\b)re"
      R"re(|\bstd::(?:vector|string|map|set|unordered_map|list|deque|any|expected|format)\b)re"
      R"re(|\bstd::(?:function|shared_ptr|unique_ptr|mutex|thread|ranges)\b)re"
      R"re(|\bstd::(?:sin|cos|tan|atan2|exp|log|pow|hypot|floor|ceil|round|lround|fmod)\b)re"};
  std::vector<Violation> violations;
  for (std::size_t i = 0; i < file.code.size(); ++i) {
    const std::string& line = file.code[i];
    if (line.rfind("#include", 0) == 0) { continue; }
    for (std::sregex_iterator match{line.begin(), line.end(), poisoned}, end; match != end;
         ++match) {
      const std::string name = match->str();
      const std::string before = match->prefix();
      if (name == "delete" && before.find_last_not_of(' ') != std::string::npos &&
          before[before.find_last_not_of(' ')] == '=') {
        continue;  // a deleted function, not the operator
      }
      violations.push_back({file.path, static_cast<int>(i) + 1, name + " is poisoned here"});
    }
  }
  return violations;
}

std::vector<Violation> header_arithmetic(const SourceFile& file) {
  // A quantity is a name with a unit, perhaps a member, perhaps called; or a float literal.
  static const std::string quantity =
      R"re((?:\b\w+_(?:m|rad|s|hz|mps|radps|mps2|m2|deg)_?\b(?:\(\))?|\b\d+\.\d*F?))re";
  static const std::regex left{quantity + R"re(\s*(?:[-+*/]=?)\s*[\w(\-])re"};
  static const std::regex right{R"re((?:\w|\))\s+(?:[-+*/]=?)\s+)re" + quantity};
  // The compiler itself computes constants, exactly and once.
  static const std::regex constant{R"re(\bconstexpr\s+\S+\s+k[A-Z]|\bstatic_assert\b)re"};
  std::vector<Violation> violations;
  for (std::size_t i = 0; i < file.code.size(); ++i) {
    const std::string& line = file.code[i];
    if (std::regex_search(line, constant)) { continue; }
    if (std::regex_search(line, left) || std::regex_search(line, right)) {
      violations.push_back({file.path, static_cast<int>(i) + 1,
                            "floating-point arithmetic belongs into a .cpp file: " + line});
    }
  }
  return violations;
}

}  // namespace picolo::layout
