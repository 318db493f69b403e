// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What a compiler may call though nobody wrote it, where there is no C library; and the two string
// functions that images use.

#include <cstddef>
#include <cstdint>

extern "C" {

void* memcpy(void* to, const void* from, std::size_t size) {
  auto* target = static_cast<std::uint8_t*>(to);
  const auto* source = static_cast<const std::uint8_t*>(from);
  for (std::size_t i = 0; i < size; ++i) { target[i] = source[i]; }
  return to;
}

void* memmove(void* to, const void* from, std::size_t size) {
  auto* target = static_cast<std::uint8_t*>(to);
  const auto* source = static_cast<const std::uint8_t*>(from);
  if (reinterpret_cast<std::uintptr_t>(target) < reinterpret_cast<std::uintptr_t>(source)) {
    return memcpy(to, from, size);
  }
  for (std::size_t i = size; i > 0; --i) { target[i - 1] = source[i - 1]; }
  return to;
}

void* memset(void* to, int value, std::size_t size) {
  auto* target = static_cast<std::uint8_t*>(to);
  for (std::size_t i = 0; i < size; ++i) { target[i] = static_cast<std::uint8_t>(value); }
  return to;
}

int memcmp(const void* a, const void* b, std::size_t size) {
  const auto* left = static_cast<const std::uint8_t*>(a);
  const auto* right = static_cast<const std::uint8_t*>(b);
  for (std::size_t i = 0; i < size; ++i) {
    if (left[i] != right[i]) { return left[i] < right[i] ? -1 : 1; }
  }
  return 0;
}

std::size_t strlen(const char* text) {
  std::size_t length = 0;
  while (text[length] != '\0') { ++length; }
  return length;
}

int strcmp(const char* a, const char* b) {
  while (*a != '\0' && *a == *b) {
    ++a;
    ++b;
  }
  return static_cast<unsigned char>(*a) - static_cast<unsigned char>(*b);
}

char* strchr(const char* text, int wanted) {
  for (;; ++text) {
    if (*text == static_cast<char>(wanted)) { return const_cast<char*>(text); }
    if (*text == '\0') { return nullptr; }
  }
}

}  // extern "C"
