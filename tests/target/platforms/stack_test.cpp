// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The deepest chain of calls in the linked image, beside what a drive really used.

#include <gtest/gtest.h>

#include <iostream>

#include "lockstep_run.hpp"
#include "stack_analysis.hpp"
#include "support/data.hpp"

namespace picolo::target {
namespace {

constexpr const char* kFrame = "picolo::(anonymous namespace)::frame(";
constexpr std::uint32_t kBoundBytes = 2048;

TEST(Stack, StaticBoundCoversWhatADriveUses) {
  PICOLO_NEED_IMAGES();
  const IndirectCalls indirect =
      read_indirect_calls((test::source_dir() / "toolchain/indirect_calls.txt").string());
  for (const Platform& platform : platforms_to_judge()) {
    if (platform.machine.rfind("mps2", 0) != 0) { continue; }
    const Outcome listing = run("arm-none-eabi-objdump -d -C --no-show-raw-insn " +
                                image(platform, "lockstep").string());
    const auto functions = parse_disassembly(listing.output);
    ASSERT_GT(functions.size(), 200U) << platform.name;
    const StackBound bound = worst_stack(functions, indirect, kFrame);
    for (const std::string& trouble : bound.trouble) {
      ADD_FAILURE() << platform.name << ": " << trouble
                    << " (calls through pointers are listed in toolchain/indirect_calls.txt)";
    }
    const auto drive = simulated_drive(sim::SceneName::hall, 6s);
    const LockstepRun run = run_lockstep(platform, *drive, false);
    EXPECT_EQ(run.trouble, "");
    // The painted depth also holds what the measuring functions and the registers of run() took.
    EXPECT_LE(run.deepest_stack_bytes, bound.bytes + 64) << platform.name;
    EXPECT_LE(bound.bytes, kBoundBytes) << platform.name;
    std::cout << "| " << platform.name << " | static " << bound.bytes << " bytes | painted "
              << run.deepest_stack_bytes << " bytes |\n";
    for (const std::string& function : bound.way) {
      std::cout << "    " << function.substr(0, 100) << "\n";
    }
  }
}

TEST(Stack, AnalysisSeesFramesCallsRecursionAndPointers) {
  const auto functions = parse_disassembly(
      "00000010 <leaf>:\n  10:\tpush\t{r4, r5, lr}\n  12:\tsub\tsp, #20\n  14:\tpop\t{r4, r5, pc}\n"
      "00000020 <caller>:\n  20:\tpush\t{r4, lr}\n  22:\tvpush\t{d8-d9}\n  24:\tbl\t10 <leaf>\n"
      "  28:\tb.w\t10 <leaf>\n"
      "00000030 <again>:\n  30:\tpush\t{lr}\n  32:\tbl\t30 <again>\n"
      "00000040 <pointer>:\n  40:\tblx\tr3\n"
      "00000050 <grows>:\n  50:\tsub.w\tsp, sp, r3\n");
  EXPECT_EQ(worst_stack(functions, {}, "leaf").bytes, 32U);
  EXPECT_EQ(worst_stack(functions, {}, "caller").bytes, 8U + 16U + 32U);
  EXPECT_EQ(worst_stack(functions, {}, "again").trouble.size(), 1U);
  EXPECT_EQ(worst_stack(functions, {}, "pointer").trouble.size(), 1U);
  EXPECT_EQ(worst_stack(functions, {{"pointer", {"leaf"}}}, "pointer").bytes, 32U);
  EXPECT_EQ(worst_stack(functions, {}, "grows").trouble.size(), 1U);
  EXPECT_EQ(worst_stack(functions, {}, "missing").trouble.size(), 1U);
}

}  // namespace
}  // namespace picolo::target
