// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "source_tree.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

#include "support/paths.hpp"

namespace picolo::layout {
namespace {

namespace fs = std::filesystem;

/// Keeps the length of every line; what is neither code nor white space becomes a blank.
std::string without_comments_and_literals(const std::string& text) {
  enum class State { code, line_comment, block_comment, string, character, raw_string };
  State state = State::code;
  std::string result = text;
  std::string raw_end;
  const auto starts = [&](std::size_t i, const std::string& what) {
    return text.compare(i, what.size(), what) == 0;
  };
  const auto blank = [&](std::size_t from, std::size_t count) {
    for (std::size_t k = from; k < std::min(from + count, text.size()); ++k) {
      if (text[k] != '\n') { result[k] = ' '; }
    }
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    switch (state) {
      case State::code:
        if (starts(i, "//")) { state = State::line_comment; }
        if (starts(i, "/*")) { state = State::block_comment; }
        if (starts(i, "R\"")) {
          const std::size_t open = text.find('(', i);
          raw_end = ")" + text.substr(i + 2, open - i - 2) + "\"";
          state = State::raw_string;
          blank(i, open - i);
          i = open;
        } else if (text[i] == '"') {
          state = State::string;
        } else if (text[i] == '\'' && (i == 0 || std::isalnum(static_cast<unsigned char>(
                                                     text[i - 1])) == 0)) {  // not 10'000
          state = State::character;
        }
        if (state != State::code) { blank(i, 1); }
        break;
      case State::line_comment:
        if (text[i] == '\n') { state = State::code; }
        blank(i, 1);
        break;
      case State::block_comment:
        if (starts(i, "*/")) {
          blank(i, 2);
          ++i;
          state = State::code;
        }
        blank(i, 1);
        break;
      case State::string:
      case State::character:
        blank(i, 1);
        if (text[i] == '\\') {
          ++i;
          blank(i, 1);
        } else if (text[i] == (state == State::string ? '"' : '\'')) {
          state = State::code;
        }
        break;
      case State::raw_string:
        if (starts(i, raw_end)) {
          blank(i, raw_end.size());
          i += raw_end.size() - 1;
          state = State::code;
        }
        blank(i, 1);
        break;
    }
  }
  return result;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);) { lines.push_back(line); }
  return lines;
}

std::string read(const fs::path& path) {
  std::ifstream stream{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{stream}, std::istreambuf_iterator<char>{}};
}

template <typename Wanted>
std::vector<SourceFile> collect(const std::vector<std::string>& folders, Wanted wanted) {
  const fs::path root = test::source_dir();
  std::vector<SourceFile> files;
  for (const std::string& folder : folders) {
    if (!fs::exists(root / folder)) { continue; }
    for (const auto& entry : fs::recursive_directory_iterator{root / folder}) {
      if (!entry.is_regular_file() || !wanted(entry.path())) { continue; }
      files.push_back(
          parse_source(fs::relative(entry.path(), root).generic_string(), read(entry.path())));
    }
  }
  std::sort(files.begin(), files.end(),
            [](const SourceFile& a, const SourceFile& b) { return a.path < b.path; });
  return files;
}

}  // namespace

SourceFile parse_source(const std::string& path, const std::string& text) {
  static const std::regex include{R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re"};
  SourceFile file;
  file.path = path;
  file.lines = lines_of(text);
  file.code = lines_of(without_comments_and_literals(text));
  for (std::size_t i = 0; i < file.lines.size(); ++i) {
    std::smatch match;
    if (std::regex_search(file.lines[i], match, include)) {
      file.includes.push_back({static_cast<int>(i) + 1, match[2], match[1] == "<"});
    }
  }
  return file;
}

const std::vector<SourceFile>& source_tree() {
  static const std::vector<SourceFile> files =
      collect({"firmware_lib", "hal", "drivers", "controller", "ports", "apps", "tests",
               "benchmarks", "examples"},
              [](const fs::path& path) {
                return path.extension() == ".cpp" || path.extension() == ".hpp";
              });
  return files;
}

std::vector<SourceFile> build_files() {
  return collect({"firmware_lib", "hal", "drivers", "controller", "ports", "apps", "tests",
                  "benchmarks", "examples", "cmake"},
                 [](const fs::path& path) {
                   return path.filename() == "CMakeLists.txt" || path.extension() == ".cmake" ||
                          path.extension() == ".awk" || path.extension() == ".bash";
                 });
}

bool starts_with_folder(const std::string& path, const std::string& folder) {
  return path.rfind(folder + "/", 0) == 0;
}

bool is_header(const SourceFile& file) {
  return file.path.ends_with(".hpp");
}

bool is_firmware(const SourceFile& file) {
  const std::array<const char*, 4> folders{"firmware_lib", "hal", "drivers", "controller"};
  return std::any_of(folders.begin(), folders.end(),
                     [&](const char* folder) { return starts_with_folder(file.path, folder); });
}

bool is_public_header(const SourceFile& file) {
  return is_header(file) && file.path.find("/include/") != std::string::npos &&
         (is_firmware(file) || starts_with_folder(file.path, "ports"));
}

}  // namespace picolo::layout
