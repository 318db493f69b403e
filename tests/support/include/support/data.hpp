// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Recorded data sets are not part of the repository: a test that needs one skips, naming what is
/// missing, or fails when PICOLO_REQUIRE contains "data".
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include <string_view>
#include "support/paths.hpp"

namespace picolo::test {

inline std::filesystem::path data_path(const std::string& name) {
  return data_dir() / name;
}

/// Whether PICOLO_REQUIRE, a list like "data,arm,vm", names the group.
inline bool group_is_required(std::string_view group) {
  const char* required = std::getenv("PICOLO_REQUIRE");  // NOLINT(concurrency-mt-unsafe)
  std::string_view rest = required == nullptr ? "" : required;
  while (!rest.empty()) {
    const std::string_view name = rest.substr(0, rest.find(','));
    if (name == group) { return true; }
    rest.remove_prefix(name.size() < rest.size() ? name.size() + 1 : name.size());
  }
  return false;
}

}  // namespace picolo::test

/// First line of a test that reads `shared/data/NAME`.
#define PICOLO_NEED_DATA(name)                                               \
  do {                                                                       \
    if (!std::filesystem::exists(picolo::test::data_path(name))) {           \
      if (picolo::test::group_is_required("data")) {                         \
        FAIL() << "PICOLO_REQUIRE asks for data, but it is missing: "        \
               << picolo::test::data_path(name);                             \
      }                                                                      \
      GTEST_SKIP() << "no recorded data: " << picolo::test::data_path(name); \
    }                                                                        \
  } while (false)
