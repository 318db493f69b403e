// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tool_run.hpp"

namespace picolo {
namespace {

using test::run_tool;
using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

TEST(Tool, HelpAndVersionAreDone) {
  const TemporaryFolder folder;
  const test::ToolRun help = run_tool(folder, {"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_THAT(help.out, HasSubstr("undistort"));
  EXPECT_THAT(help.out, HasSubstr("Exit codes"));
  EXPECT_THAT(help.err, IsEmpty());
  const test::ToolRun version = run_tool(folder, {"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, StartsWith("picolo 0."));
}

TEST(Tool, EveryCommandTeachesByExamples) {
  const TemporaryFolder folder;
  for (const char* command : {"demo", "replay", "undistort"}) {
    const test::ToolRun help = run_tool(folder, {command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Example"));
    EXPECT_THAT(help.out, HasSubstr("--json"));
    EXPECT_THAT(help.out, HasSubstr("--out"));
  }
}

TEST(Tool, WrongUsageIs2AndNothingGoesToStandardOutput) {
  const TemporaryFolder folder;
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{},
                                                    {"fly"},
                                                    {"undistort"},
                                                    {"undistort", "a", "--nonsense"},
                                                    {"undistort", "a", "--cell", "wide"},
                                                    {"undistort", "a", "--lidar", "1", "2"}}) {
    const test::ToolRun run = run_tool(folder, arguments);
    EXPECT_EQ(run.exit_code, 2) << ::testing::PrintToString(arguments);
    EXPECT_THAT(run.out, IsEmpty());
    EXPECT_THAT(run.err, ::testing::Not(IsEmpty()));
  }
}

TEST(Tool, UnreadableInputIs3AndNamesFileCauseAndCure) {
  const TemporaryFolder folder;
  const test::ToolRun run = run_tool(folder, {"undistort", "missing.gz", "--json"});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.out, IsEmpty());
  EXPECT_EQ(run.err,
            "picolo: missing.gz: cannot be opened: No such file or directory; check the path\n");
}

TEST(Tool, InputWithoutAValidRecordIs3) {
  const TemporaryFolder folder;
  for (const char* content : {"", "hello\n", "SWEEP 1\n", "\x1f\x8b"}) {
    const test::ToolRun run =
        run_tool(folder, {"undistort", folder.write("a.log", content), "--json"});
    EXPECT_EQ(run.exit_code, 3) << content;
    EXPECT_THAT(run.out, IsEmpty());
    EXPECT_THAT(run.err, HasSubstr("a.log"));
  }
}

}  // namespace
}  // namespace picolo
