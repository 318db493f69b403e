// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Instructions of every executive task over simulated drives, counted by QEMU, against the declared
// budgets of work_budgets.txt. QEMU counts; it does not time.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "lockstep_run.hpp"
#include "picolo/controller/controller_config.hpp"
#include "support/data.hpp"

namespace picolo::target {
namespace {

constexpr std::size_t kUndistort = static_cast<std::size_t>(ControllerTask::undistort);
constexpr std::size_t kMatch = static_cast<std::size_t>(ControllerTask::match);
constexpr std::size_t kMap = static_cast<std::size_t>(ControllerTask::map);

/// Samples by row of the table.
using Samples = std::map<std::string, std::vector<std::uint64_t>>;

/// -icount shift=6: 64 ns an instruction, and the timer ticks every 40 ns.
std::uint64_t instructions(std::uint64_t ticks) {
  return ticks * 5 / 8;
}

void add_run(const LockstepRun& run, Samples& samples) {
  const auto table = controller_tasks(WorkBounds{}, TaskBudgets{});
  std::uint64_t scan = 0;
  std::size_t sweep = 0;
  for (std::uint32_t frame = 0; frame < run.frames; ++frame) {
    const std::vector<std::uint32_t>& ticks = run.ticks[frame];
    for (std::size_t task = 0; task < ticks.size(); ++task) {
      // A run without work is a few instructions; it would hide the median of the others.
      if (ticks[task] > 400) { samples[table[task].name].push_back(instructions(ticks[task])); }
    }
    scan += ticks[kUndistort] + ticks[kMatch] + ticks[kMap];
    if (sweep < run.sweep_ends.size() && run.sweep_ends[sweep] == frame) {
      // What follows a sweep's end is its successor's; the first sweep has no map to match.
      if (sweep > 1) {
        samples[run.searched[sweep] ? "scan-with-search" : "scan"].push_back(instructions(scan));
      }
      scan = 0;
      ++sweep;
    }
  }
}

std::map<std::string, std::uint64_t> budgets_of(const Platform& platform) {
  std::map<std::string, std::uint64_t> budgets;
  std::ifstream file(test::source_dir() / "tests/target/platforms/work_budgets.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string preset;
    std::string row;
    std::uint64_t budget = 0;
    if (words >> preset >> row >> budget && preset == platform.preset) { budgets[row] = budget; }
  }
  return budgets;
}

void judge(const Platform& platform) {
  Samples samples;
  std::uint32_t stack = 0;
  for (const sim::SceneName scene : {sim::SceneName::office, sim::SceneName::hall}) {
    const LockstepRun run = run_lockstep(platform, scene, 12s, true);
    ASSERT_EQ(run.trouble, "") << platform.name;
    add_run(run, samples);
    stack = std::max(stack, run.deepest_stack_bytes);
  }
  const auto budgets = budgets_of(platform);
  for (auto& [row, values] : samples) {
    std::sort(values.begin(), values.end());
    const std::uint64_t median = values[values.size() / 2];
    const std::uint64_t worst = values.back();
    const auto declared = budgets.find(row);
    const std::uint64_t budget = declared == budgets.end() ? 0 : declared->second;
    std::cout << "| " << platform.name << " | " << row << " | " << values.size() << " | " << median
              << " | " << worst << " | " << static_cast<double>(worst) / static_cast<double>(median)
              << " | " << budget << " |\n";
    EXPECT_GE(budget, worst * 5 / 4)
        << platform.name << ", " << row << ": less than 1.25 times the worst";
    EXPECT_LE(budget, worst * 2) << platform.name << ", " << row << ": more than twice the worst";
  }
  std::cout << "| " << platform.name << " | deepest stack of a frame | | | " << stack
            << " bytes | | |\n";
}

TEST(Work, OfEveryTaskKeepsToItsBudget) {
  PICOLO_NEED_IMAGES();
  std::cout << "| platform | task | runs | median | worst | worst/median | budget |\n"
               "|---|---|---|---|---|---|---|\n";
  for (const Platform& platform : platforms_to_judge()) {
    if (platform.machine.rfind("mps2", 0) == 0) { judge(platform); }
  }
}

}  // namespace
}  // namespace picolo::target
