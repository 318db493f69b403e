// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Lines of a gzipped text file, and their numbers. Link ZLIB::ZLIB.
#pragma once

#include <zlib.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace picolo::test {

/// Every line without its end; empty when the file cannot be read.
inline std::vector<std::string> gz_lines(const std::filesystem::path& path) {
  std::vector<std::string> lines;
  gzFile file = gzopen(path.c_str(), "rb");
  if (file == nullptr) { return lines; }
  std::string line;
  for (int c = gzgetc(file); c != -1; c = gzgetc(file)) {
    if (c == '\n') {
      lines.push_back(line);
      line.clear();
    } else {
      line.push_back(static_cast<char>(c));
    }
  }
  if (!line.empty()) { lines.push_back(line); }
  gzclose(file);
  return lines;
}

/// All numbers of a text, whatever stands between them.
inline std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> values;
  const char* at = text.c_str();
  while (*at != '\0') {
    char* end = nullptr;
    const double value = std::strtod(at, &end);
    if (end == at) {
      ++at;
    } else {
      values.push_back(value);
      at = end;
    }
  }
  return values;
}

}  // namespace picolo::test
