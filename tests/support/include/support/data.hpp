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

namespace picolo::test {

inline std::filesystem::path data_path(const std::string& name) {
  return std::filesystem::path{PICOLO_TEST_DATA} / name;
}

inline bool group_is_required(const std::string& group) {
  const char* required = std::getenv("PICOLO_REQUIRE");  // NOLINT(concurrency-mt-unsafe)
  return required != nullptr &&
         ("," + std::string{required} + ",").find("," + group + ",") != std::string::npos;
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
