// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The include table of docs/architecture.md holds for every file; and the check itself sees what it
// must.

#include <gtest/gtest.h>

#include <string>

#include "include_rules.hpp"
#include "source_tree.hpp"
#include "support/paths.hpp"

namespace picolo::layout {
namespace {

std::size_t violations_of(const std::string& path, const std::string& include) {
  return include_violations(parse_source(path, "#include " + include + "\n")).size();
}

TEST(IncludeTable, HoldsForEveryFileOfTheTree) {
  ASSERT_GT(source_tree().size(), 50U) << "the tree was not found at " << test::source_dir();
  for (const SourceFile& file : source_tree()) {
    for (const Violation& violation : include_violations(file)) {
      ADD_FAILURE_AT(violation.path.c_str(), violation.line) << violation.rule;
    }
  }
}

TEST(IncludeTable, FindsAnIncludeThatPointsUpward) {
  EXPECT_EQ(violations_of("firmware_lib/core/a.cpp", "\"picolo/geometry/pose2.hpp\""), 1U);
  EXPECT_EQ(violations_of("firmware_lib/map/a.cpp", "\"picolo/matching/gauss_newton.hpp\""), 1U);
  EXPECT_EQ(violations_of("firmware_lib/map/a.cpp", "\"picolo/solve/normal_equations.hpp\""), 1U);
  EXPECT_EQ(violations_of("firmware_lib/calibration/a.cpp", "\"picolo/localisation/health.hpp\""),
            1U);
  EXPECT_EQ(violations_of("firmware_lib/sensing/a.cpp", "\"picolo/hal/clock.hpp\""), 1U);
  EXPECT_EQ(violations_of("hal/include/picolo/hal/a.hpp", "\"picolo/geometry/pose2.hpp\""), 1U);
  EXPECT_EQ(violations_of("controller/a.cpp", "\"picolo/sim/world.hpp\""), 1U);
}

TEST(IncludeTable, FindsADriverThatSeesTooMuch) {
  EXPECT_EQ(violations_of("drivers/ld06/a.cpp", "\"picolo/geometry/pose2.hpp\""), 1U);
  EXPECT_EQ(violations_of("drivers/ld06/a.cpp", "\"picolo/drivers/canopen/messages.hpp\""), 1U);
  EXPECT_EQ(violations_of("drivers/ld06/a.cpp", "\"picolo/drivers/common/framer.hpp\""), 0U);
}

TEST(IncludeTable, FindsAPortThatSeesTooMuch) {
  EXPECT_EQ(violations_of("ports/linux/a.cpp", "\"picolo/map/rolling_map.hpp\""), 1U);
  EXPECT_EQ(violations_of("ports/linux/a.cpp", "\"picolo/sim/world.hpp\""), 1U);
  EXPECT_EQ(violations_of("ports/sim/a.cpp", "\"picolo/drivers/ld06/ld06.hpp\""), 1U);
  EXPECT_EQ(violations_of("ports/sim/a.cpp", "\"picolo/geometry/pose2.hpp\""), 0U);
}

TEST(IncludeTable, KeepsSystemHeadersWhereTheyBelong) {
  EXPECT_EQ(violations_of("drivers/ld06/a.cpp", "<termios.h>"), 1U);
  EXPECT_EQ(violations_of("ports/linux/include/picolo/linux/a.hpp", "<sys/socket.h>"), 1U);
  EXPECT_EQ(violations_of("ports/linux/a.cpp", "<sys/socket.h>"), 0U);
  EXPECT_EQ(violations_of("firmware_lib/core/a.cpp", "<vector>"), 1U);
  EXPECT_EQ(violations_of("firmware_lib/core/a.cpp", "<chrono>"), 1U);
  EXPECT_EQ(violations_of("firmware_lib/core/a.cpp", "<atomic>"), 1U);
  EXPECT_EQ(violations_of("firmware_lib/core/a.cpp", "<Eigen/Core>"), 1U);
  EXPECT_EQ(violations_of("firmware_lib/map/include/picolo/map/a.hpp", "<Eigen/Core>"), 1U);
  EXPECT_EQ(violations_of("firmware_lib/map/a.cpp", "<Eigen/Core>"), 0U);
}

TEST(IncludeTable, WantsIncludesFromTheRoot) {
  EXPECT_EQ(violations_of("firmware_lib/map/a.cpp", "\"../core/math.hpp\""), 1U);
  EXPECT_EQ(violations_of("firmware_lib/map/a.cpp", "\"not_there.hpp\""), 1U);
}

TEST(SourceTree, IncludesAreReadFromCodeAsWrittenAndCommentsAreBlanked) {
  const SourceFile file = parse_source(
      "a.cpp",
      "#include <array>  // why\nint a = 1'000;  // new\nconst char* b = \"new\\\"\"; b;\n"
      "/* delete\n throw */ int c;\nauto d = R\"(try)\"; d;\n");
  ASSERT_EQ(file.includes.size(), 1U);
  EXPECT_EQ(file.includes[0].target, "array");
  EXPECT_EQ(file.code[1], "int a = 1'000;        ");
  EXPECT_EQ(file.code[2], "const char* b =        ; b;");
  EXPECT_EQ(file.code[4], "          int c;");
  EXPECT_EQ(file.code[5], "auto d =         ; d;");
}

}  // namespace
}  // namespace picolo::layout
