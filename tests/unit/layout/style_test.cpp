// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Rules of the style that the text of the sources can break, and proof that the checks can fail.

#include <gtest/gtest.h>

#include <string>

#include "source_tree.hpp"
#include "style_rules.hpp"

namespace picolo::layout {
namespace {

void expect_none(const std::vector<Violation>& violations) {
  for (const Violation& violation : violations) {
    ADD_FAILURE_AT(violation.path.c_str(), violation.line) << violation.rule;
  }
}

const std::string kLicence =
    "// SPDX-FileCopyrightText: picolo contributors\n// SPDX-License-Identifier: Apache-2.0\n";

SourceFile firmware(const std::string& code) {
  return parse_source("firmware_lib/map/a.cpp", code);
}

SourceFile public_header(const std::string& code) {
  return parse_source("firmware_lib/map/include/picolo/map/a.hpp", code);
}

TEST(Style, EverySourceHasLicenceLengthAndWidth) {
  for (const SourceFile& file : source_tree()) { expect_none(form_violations(file)); }
  for (const SourceFile& file : build_files()) { expect_none(licence_violations(file)); }
}

TEST(Style, NoPoisonedNamesInWhatRunsOnTheTarget) {
  for (const SourceFile& file : source_tree()) {
    if (is_firmware(file)) { expect_none(poisoned_names(file)); }
  }
}

TEST(Style, NoArithmeticOnQuantitiesInPublicHeaders) {
  for (const SourceFile& file : source_tree()) {
    if (is_firmware(file) && is_public_header(file)) { expect_none(header_arithmetic(file)); }
  }
}

TEST(StyleCheck, FindsWhatIsMissingInAFile) {
  EXPECT_TRUE(form_violations(parse_source("a.cpp", kLicence)).empty());
  EXPECT_EQ(form_violations(parse_source("a.cpp", "int a;\n")).size(), 1U);
  EXPECT_EQ(form_violations(parse_source("a.hpp", kLicence)).size(), 1U);
  EXPECT_EQ(form_violations(parse_source("a.cpp", kLicence + std::string(101, 'x') + "\n")).size(),
            1U);
  std::string lines = kLicence;
  for (int i = 0; i < 400; ++i) { lines += "\n"; }
  EXPECT_EQ(form_violations(parse_source("a.cpp", lines)).size(), 1U);
}

TEST(StyleCheck, FindsPoisonedNamesInCodeOnly) {
  EXPECT_EQ(poisoned_names(firmware("auto a = new int;\n")).size(), 1U);
  EXPECT_EQ(poisoned_names(firmware("try { throw 1; } catch (...) {}\n")).size(), 3U);
  EXPECT_EQ(poisoned_names(firmware("std::vector<int> a;\n")).size(), 1U);
  EXPECT_EQ(poisoned_names(firmware("float a = std::sin(1.0F);\n")).size(), 1U);
  EXPECT_EQ(poisoned_names(firmware("Eigen::Matrix<float, Eigen::Dynamic, 1> a;\n")).size(), 1U);
  EXPECT_TRUE(poisoned_names(firmware("A(const A&) = delete;  // new, delete\n")).empty());
  EXPECT_TRUE(poisoned_names(firmware("int newest = 0; bool is_free = true;\n")).empty());
}

TEST(StyleCheck, FindsArithmeticOnQuantities) {
  EXPECT_EQ(header_arithmetic(public_header("return x_m * 2.0F;\n")).size(), 1U);
  EXPECT_EQ(header_arithmetic(public_header("return a.x_m - b.x_m;\n")).size(), 1U);
  EXPECT_EQ(header_arithmetic(public_header("total_s += step;\n")).size(), 1U);
  EXPECT_EQ(header_arithmetic(public_header("return scale / width_m();\n")).size(), 1U);
  EXPECT_EQ(header_arithmetic(public_header("return 0.5F * value;\n")).size(), 1U);
}

TEST(StyleCheck, ComparisonsConstantsAndPointersAreNotArithmetic) {
  EXPECT_TRUE(header_arithmetic(public_header("return a_m >= min_m && a_m <= max_m;\n")).empty());
  EXPECT_TRUE(header_arithmetic(public_header("constexpr float kThird = 1.0F / 3.0F;\n")).empty());
  EXPECT_TRUE(header_arithmetic(public_header("void f(const float* x_m, float* y_m);\n")).empty());
  EXPECT_TRUE(header_arithmetic(public_header("float low_m = -1.0F;\n")).empty());
  EXPECT_TRUE(header_arithmetic(public_header("return pose->x_m;\n")).empty());
  EXPECT_TRUE(header_arithmetic(public_header("float range_m = 0.0F;  // a - b\n")).empty());
}

}  // namespace
}  // namespace picolo::layout
