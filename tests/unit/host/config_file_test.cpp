// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/config_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "picolo/host/error.hpp"
#include "support/files.hpp"

namespace picolo {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

template <typename Action>
host::UserError error_of(Action action) {
  try {
    action();
  } catch (const host::UserError& error) { return error; }
  ADD_FAILURE() << "nothing was thrown";
  return {host::ExitCode::done, "", "", ""};
}

TEST(ConfigFile, NoFileLeavesTheDefaults) {
  host::ConfigFile config{""};
  int value = 7;
  config.read("a", "b", value);
  EXPECT_EQ(value, 7);
  EXPECT_NO_THROW(config.reject_unknown());
}

TEST(ConfigFile, KeysOfSectionsReplaceDefaults) {
  const TemporaryFolder folder;
  host::ConfigFile config{folder.write(
      "c.toml", "top = true\n[a]\nn = 3\nx = 0.5\nwhole = 2\n[a.b]\nname = \"site\"\n")};
  bool top = false;
  int n = 0;
  double x = 0.0;
  float whole = 0.0F;
  std::string name;
  config.read("", "top", top);
  config.read("a", "n", n);
  config.read("a", "x", x);
  config.read("a", "whole", whole);
  config.read("a.b", "name", name);
  EXPECT_TRUE(top);
  EXPECT_EQ(n, 3);
  EXPECT_EQ(x, 0.5);
  EXPECT_EQ(whole, 2.0F);
  EXPECT_EQ(name, "site");
  EXPECT_NO_THROW(config.reject_unknown());
}

TEST(ConfigFile, AKeyNobodyAskedForIsNamedWithItsLine) {
  const TemporaryFolder folder;
  const std::string path = folder.write("c.toml", "[a]\nn = 3\nmax_iteratoins = 5\n");
  host::ConfigFile config{path};
  int n = 0;
  config.read("a", "n", n);
  const host::UserError error = error_of([&] { config.reject_unknown(); });
  EXPECT_EQ(error.code(), host::ExitCode::usage);
  EXPECT_THAT(error.what(), HasSubstr(path + ":3: unknown key 'a.max_iteratoins'"));
  EXPECT_NO_THROW(config.reject_unknown({"a"}));
}

TEST(ConfigFile, WrongTypesAreNamedWithTheirLine) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("c.toml", "n = 1.5\nx = \"1\"\nb = 1\ns = 2\nbig = 99999999999\n");
  host::ConfigFile config{path};
  int n = 0;
  double x = 0.0;
  bool b = false;
  std::string s;
  EXPECT_THAT(error_of([&] { config.read("", "n", n); }).what(), HasSubstr(path + ":1: "));
  EXPECT_THAT(error_of([&] { config.read("", "x", x); }).what(), HasSubstr(path + ":2: "));
  EXPECT_THAT(error_of([&] { config.read("", "b", b); }).what(), HasSubstr(path + ":3: "));
  EXPECT_THAT(error_of([&] { config.read("", "s", s); }).what(), HasSubstr(path + ":4: "));
  EXPECT_THAT(error_of([&] { config.read("", "big", n); }).what(), HasSubstr(path + ":5: "));
}

TEST(ConfigFile, ABrokenOrMissingFileIsToldApart) {
  const TemporaryFolder folder;
  const std::string path = folder.write("c.toml", "a = 1\n= 2\n");
  const host::UserError broken = error_of([&] { host::ConfigFile config{path}; });
  EXPECT_EQ(broken.code(), host::ExitCode::usage);
  EXPECT_THAT(broken.what(), HasSubstr(path + ":2: "));
  const host::UserError missing =
      error_of([&] { host::ConfigFile config{folder.file("no.toml")}; });
  EXPECT_EQ(missing.code(), host::ExitCode::input);
}

}  // namespace
}  // namespace picolo
