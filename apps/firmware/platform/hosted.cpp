// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <cstdio>
#include <cstdlib>

#include "platform.hpp"

namespace picolo::platform {
namespace {

constinit int g_count = 0;
constinit char** g_words = nullptr;
constinit std::FILE* g_file = nullptr;
constinit std::FILE* g_output = nullptr;

}  // namespace

// Before main, so that an image has the same main everywhere.
[[gnu::constructor]] static void keep_words(int count, char** words) {
  g_count = count;
  g_words = words;
}

void argument(std::size_t index, std::span<char> word) {
  std::snprintf(word.data(), word.size(), "%s",
                index + 1 < static_cast<std::size_t>(g_count) ? g_words[index + 1] : "");
}

void write(const char* text) {
  std::fputs(text, stdout);
}

int open_file(const char* path) {
  g_file = std::fopen(path, "rb");
  return g_file == nullptr ? -1 : 0;
}

std::size_t read_file(int /*file*/, std::span<std::uint8_t> bytes) {
  return std::fread(bytes.data(), 1, bytes.size(), g_file);
}

int open_output(const char* path) {
  g_output = std::fopen(path, "wb");
  return g_output == nullptr ? -1 : 0;
}

bool write_file(int /*file*/, std::span<const std::uint8_t> bytes) {
  return std::fwrite(bytes.data(), 1, bytes.size(), g_output) == bytes.size() &&
         std::fflush(g_output) == 0;
}

std::uint32_t ticks() {
  return 0;
}

void pause() {}

void leave(int status) {
  std::exit(status);
}

}  // namespace picolo::platform
