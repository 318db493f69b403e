// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "picolo/host/error.hpp"

namespace picolo::host {

void make_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error || !std::filesystem::is_directory(path)) {
    throw UserError{
        ExitCode::usage, path.string(),
        "cannot be made a folder: " + (error ? error.message() : "a file is in the way"),
        "give another --out"};
  }
}

void write_file(const std::filesystem::path& path, std::string_view content) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) {
    throw UserError{ExitCode::usage, path.string(),
                    std::string{"cannot be written: "} + std::strerror(errno),
                    "give another --out"};
  }
  const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
  const bool closed = std::fclose(file) == 0;
  if (!written || !closed) {
    throw UserError{ExitCode::device, path.string(),
                    std::string{"writing failed: "} + std::strerror(errno), "free some space"};
  }
}

std::string read_file(const std::filesystem::path& path, const std::string& cure) {
  std::error_code none;
  if (std::filesystem::is_directory(path, none)) {
    throw UserError{ExitCode::input, path.string(), "is a folder", cure};
  }
  std::ifstream file{path, std::ios::binary};
  if (!file) {
    throw UserError{ExitCode::input, path.string(),
                    std::string{"cannot be read: "} + std::strerror(errno), cure};
  }
  return {std::istreambuf_iterator<char>{file}, std::istreambuf_iterator<char>{}};
}

}  // namespace picolo::host
