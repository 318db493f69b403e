// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "style_rules.hpp"

#include <cctype>
#include <regex>
#include <set>
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

const std::set<std::string>& poisoned_everywhere() {
  static const std::set<std::string> names{
      "new",         "delete",   "malloc",       "calloc",
      "realloc",     "free",     "throw",        "try",
      "catch",       "typeid",   "printf",       "snprintf",
      "sprintf",     "fprintf",  "rand",         "srand",
      "abort",       "goto",     "setjmp",       "longjmp",
      "Dynamic",     "MatrixXd", "MatrixXf",     "VectorXd",
      "VectorXf",    "volatile", "dynamic_cast", "reinterpret_cast",
      "thread_local"};
  return names;
}

const std::set<std::string>& poisoned_of_std() {
  static const std::set<std::string> names{
      "vector",   "string",     "map",        "set",    "unordered_map", "list",
      "deque",    "any",        "mutex",      "thread", "format",        "expected",
      "function", "shared_ptr", "unique_ptr", "ranges", "sin",           "cos",
      "tan",      "atan2",      "exp",        "log",    "pow",           "hypot",
      "floor",    "ceil",       "round",      "lround", "fmod"};
  return names;
}

struct Word {
  std::string name;
  bool in_std = false;  ///< stands behind std::
  char before = ' ';    ///< the last character before it that is no blank
};

bool is_word_character(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

std::vector<Word> words_of(const std::string& line) {
  std::vector<Word> words;
  char before = ' ';
  for (std::size_t i = 0; i < line.size();) {
    std::size_t end = i;
    while (end < line.size() && is_word_character(line[end])) { ++end; }
    if (end == i) {
      if (line[i] != ' ') { before = line[i]; }
      ++i;
      continue;
    }
    const bool in_std = i >= 5 && line.compare(i - 5, 5, "std::") == 0;
    words.push_back({line.substr(i, end - i), in_std, before});
    before = line[end - 1];
    i = end;
  }
  return words;
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
  std::vector<Violation> violations;
  for (std::size_t i = 0; i < file.code.size(); ++i) {
    const std::string& line = file.code[i];
    if (line.rfind("#include", 0) == 0) { continue; }
    for (const Word& word : words_of(line)) {
      const bool deleted_function = word.name == "delete" && word.before == '=';
      const bool poisoned = poisoned_everywhere().contains(word.name) ||
                            (word.in_std && poisoned_of_std().contains(word.name));
      if (poisoned && !deleted_function) {
        violations.push_back({file.path, static_cast<int>(i) + 1, word.name + " is poisoned here"});
      }
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
