// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Instructions of every executive task over simulated and recorded drives, counted by QEMU, against
// the declared budgets of work_model.hpp. QEMU counts; it does not time.

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <map>

#include "lockstep_run.hpp"
#include "picolo/controller/controller_config.hpp"
#include "picolo/simulated/board_config.hpp"
#include "picolo/simulated/trajectory_hash.hpp"
#include "support/data.hpp"
#include "support/wired_drive.hpp"
#include "work_model.hpp"

namespace picolo::target {
namespace {

constexpr std::size_t kUndistort = static_cast<std::size_t>(ControllerTask::undistort);
constexpr std::size_t kMatch = static_cast<std::size_t>(ControllerTask::match);
constexpr std::size_t kMap = static_cast<std::size_t>(ControllerTask::map);
constexpr std::size_t kBackground = static_cast<std::size_t>(ControllerTask::background);

/// Samples by row of the table.
using Samples = std::map<std::string, std::vector<std::uint64_t>>;
using Budgets = std::map<std::string, double>;

struct Figures {
  std::uint64_t median = 0;
  std::uint64_t worst = 0;
  std::uint64_t budget = 0;
};
/// By row, then by platform: the table of docs/targets.md.
using Table = std::map<std::string, std::map<std::string, Figures>>;

/// -icount shift=6: 64 ns an instruction, and the timer ticks every 40 ns.
std::uint64_t instructions(std::uint64_t ticks) {
  return ticks * 5 / 8;
}

const UnitCosts& costs_of(const Platform& platform) {
  return platform.software_doubles() ? kCortexM4F : kCortexM7;
}

const char* row_of(BackgroundWork work) {
  switch (work) {
    case BackgroundWork::search: return "search";
    case BackgroundWork::relocalisation: return "relocalisation";
    case BackgroundWork::calibration: return "calibration";
    case BackgroundWork::none: break;
  }
  return "idle";
}

void add_tasks(const LockstepRun& run, Samples& samples) {
  const auto table = controller_tasks(WorkBounds{}, TaskBudgets{});
  for (std::uint32_t frame = 0; frame < run.frames; ++frame) {
    const std::vector<std::uint32_t>& ticks = run.ticks[frame];
    for (std::size_t task = 0; task < ticks.size(); ++task) {
      // A run without work is a few instructions; it would hide the median of the others.
      if (ticks[task] <= 400) { continue; }
      const char* const row =
          task == kBackground ? row_of(run.background[frame]) : table[task].name;
      samples[row].push_back(instructions(ticks[task]));
    }
  }
}

/// What follows a sweep's end is its successor's.
void add_sweeps(const LockstepRun& run, const UnitCosts& unit, bool calibrates, Samples& samples) {
  std::uint32_t frame = 0;
  for (std::size_t k = 0; k < run.sweeps.size(); ++k) {
    const SweepRun& sweep = run.sweeps[k];
    std::uint64_t ticks = 0;
    for (; frame <= sweep.last_frame; ++frame) {
      ticks += run.ticks[frame][kUndistort] + run.ticks[frame][kMatch] + run.ticks[frame][kMap];
    }
    const std::uint64_t spent = instructions(ticks);
    // The calibration takes a copy of each sweep.
    if (!sweep.searched && !calibrates) {
      EXPECT_LE(static_cast<double>(spent), cost_of(unit, sweep.work)) << "sweep " << k;
    }
    // The first sweeps have no map to match.
    if (k > 1) { samples[sweep.searched ? "scan-with-search" : "scan"].push_back(spent); }
  }
}

Figures figures_of(std::vector<std::uint64_t> values, double budget) {
  std::sort(values.begin(), values.end());
  return {values[values.size() / 2], values.back(), static_cast<std::uint64_t>(budget)};
}

double ratio_of(const Figures& figures) {
  return static_cast<double>(figures.worst) / static_cast<double>(figures.median);
}

void judge(const Platform& platform, const std::string& name, Drive& drive, bool calibrates,
           Samples& all) {
  const LockstepRun run = run_lockstep(platform, drive, true, calibrates);
  ASSERT_EQ(run.trouble, "") << platform.name << ", " << name;
  EXPECT_EQ(run.unequal, 0U) << platform.name << ", " << name;
  Samples samples;
  add_tasks(run, samples);
  add_sweeps(run, costs_of(platform), calibrates, samples);
  for (const auto& [row, values] : samples) {
    const Figures figures = figures_of(values, 0.0);
    std::cout << "| " << platform.name << " | " << name << " | " << row << " | " << values.size()
              << " | " << figures.median << " | " << figures.worst << " | " << ratio_of(figures)
              << " |\n";
    // Of the other drives: where the routine lets the vehicle drive is a small room.
    if (calibrates && row == "scan") { continue; }
    all[row].insert(all[row].end(), values.begin(), values.end());
  }
  std::cout << platform.name << ", " << name << ": " << run.sweeps.size() << " sweeps, "
            << run.replaced << " replaced by newer ones, error " << run.final_error_m << " m\n";
  if (calibrates) { EXPECT_EQ(run.calibration.phase, CalibrationPhase::done); }
}

void judge_budgets(const Platform& platform, const Samples& all, Table& table) {
  for (const auto& [row, budget] :
       declared_budgets(costs_of(platform), board_config(platform.software_doubles()))) {
    if (row == "background") { continue; }  // its work has rows of its own
    const auto values = all.find(row);
    if (values == all.end()) {
      ADD_FAILURE() << platform.name << ": no drive needed " << row;
      continue;
    }
    const Figures figures = figures_of(values->second, budget);
    table[row][platform.name] = figures;
    const auto worst = static_cast<double>(figures.worst);
    EXPECT_GE(budget, 1.25 * worst) << platform.name << ", " << row;
    // The slowest sweep is not among these: tests/integration/slowest_sweep looks for it.
    if (row.rfind("scan", 0) != 0) {
      EXPECT_LE(budget, 2.0 * worst) << platform.name << ", " << row;
    } else if (row == "scan") {
      EXPECT_LE(ratio_of(figures), 1.5) << platform.name;
    }
  }
}

void print(const Table& table) {
  std::cout << "\n| instructions |";
  std::string line = "\n|---|";
  for (const auto& [platform, figures] : table.begin()->second) {
    std::cout << ' ' << platform << " median | worst | budget |";
    line += "---|---|---|";
  }
  std::cout << line << '\n';
  for (const auto& [row, platforms] : table) {
    std::cout << "| " << row << " |";
    for (const auto& [platform, figures] : platforms) {
      std::cout << ' ' << figures.median << " | " << figures.worst << " | " << figures.budget
                << " |";
    }
    std::cout << '\n';
  }
}

/// The vehicle is told that it is elsewhere: it searches the whole map.
std::unique_ptr<Drive> misplaced_drive() {
  Command command;
  command.kind = CommandKind::set_pose;
  command.map_T_base = {2.0, 1.5, 1.0};
  return simulated_drive(hashed_drive(sim::SceneName::office), 8s, {{4s, command}});
}

std::unique_ptr<Drive> calibrating_drive() {
  Command start;
  start.kind = CommandKind::start_calibration;
  start.detail = kCalibrateAll;
  Command finish = start;
  finish.detail = kFinishCalibration;
  return simulated_drive(test::calibration_drive(), 110s, {{1s, start}, {95s, finish}});
}

TEST(Work, OfEveryTaskKeepsToItsBudget) {
  PICOLO_NEED_IMAGES();
  std::cout << "| platform | drive | task | runs | median | worst | worst/median |\n"
               "|---|---|---|---|---|---|---|\n";
  Table table;
  for (const Platform& platform : platforms_to_judge()) {
    if (platform.preset != "target-m7" && platform.preset != "target-m4f") { continue; }
    Samples all;
    judge(platform, "office", *simulated_drive(sim::SceneName::office, 12s), false, all);
    judge(platform, "hall", *simulated_drive(sim::SceneName::hall, 12s), false, all);
    judge(platform, "misplaced", *misplaced_drive(), false, all);
    judge(platform, "calibration", *calibrating_drive(), true, all);
    for (const char* name : {"freiburg-079", "freiburg-101", "intel"}) {
      const auto log = test::data_path(std::string{"radish/"} + name + ".clf.gz");
      if (!std::filesystem::exists(log)) { continue; }
      judge(platform, name, *recorded_drive(log.string(), 0, 100), false, all);
    }
    judge_budgets(platform, all, table);
  }
  if (!table.empty()) { print(table); }
}

}  // namespace
}  // namespace picolo::target
