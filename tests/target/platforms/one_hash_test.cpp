// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// One number a drive, whatever computed it: the table of every platform against the committed file.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <span>
#include <sstream>
#include <string>

#include "platforms.hpp"
#include "recorded_sweeps.hpp"
#include "support/files.hpp"

namespace picolo::target {
namespace {

using Hashes = std::map<std::string, std::string>;

Hashes read(std::istream& stream) {
  Hashes hashes;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string name;
    std::string value;
    if (words >> name >> value && name[0] != '#') { hashes[name] = value; }
  }
  return hashes;
}

Hashes committed() {
  std::ifstream file(test::source_dir() / "tests/integration/hashes/hashes.txt");
  return read(file);
}

using Names = std::span<const char* const>;
constexpr const char* kCases[] = {"sim/office", "sim/corridor", "sim/hall", "sim3d/yard",
                                  "arithmetic/ieee754"};

void print_head(Names names) {
  std::cout << "| platform                          ";
  for (const char* name : names) { std::cout << " | " << name; }
  std::cout << " | run |\n|---|";
  for (std::size_t i = 0; i < names.size(); ++i) { std::cout << "---|"; }
  std::cout << "---|\n";
}

/// One row: what an image printed, against the committed hashes.
void judge(const Outcome& outcome, const std::string& title, Names names) {
  EXPECT_EQ(outcome.status, 0) << title << ": " << outcome.output;
  std::istringstream lines(outcome.output);
  const Hashes found = read(lines);
  const Hashes wanted = committed();
  std::cout << "| " << title << std::string(title.size() < 34 ? 34 - title.size() : 0, ' ');
  for (const char* name : names) {
    const auto value = found.find(name);
    const std::string hash = value == found.end() ? "(none)" : value->second;
    EXPECT_EQ(hash, wanted.at(name)) << title << ", " << name;
    std::cout << " | " << hash << (hash == wanted.at(name) ? "" : " DIFFERS");
  }
  std::cout << " | " << outcome.seconds << " s |\n" << std::flush;
}

TEST(OneHash, IsWhatEveryPlatformFinds) {
  PICOLO_NEED_IMAGES();
  print_head(kCases);
  for (const Platform& platform : platforms_to_judge()) {
    judge(run(platform, "determinism"), platform.name, kCases);
    if (platform.machine.empty()) {
      // Linked into a program built with fused multiply-adds and vectorised Eigen.
      judge(run(platform, "hostile"), platform.name + ", hostile consumer", kCases);
    }
  }
}

/// Recorded logs that a board's memory and QEMU's patience allow.
struct RecordedCase {
  const char* name;
  std::size_t scans;
};
constexpr RecordedCase kRecorded[] = {{"radish/freiburg-101", 292}, {"raw2d/mines_exp1", 300}};
constexpr const char* kRecordedNames[] = {kRecorded[0].name, kRecorded[1].name};

std::string sweeps_file(const test::TemporaryFolder& folder, const RecordedCase& recorded) {
  return folder.file(std::filesystem::path{recorded.name}.filename().string());
}

/// What `determinism log FILE` reads: x y theta (double), count (u32), count x (float), count y;
/// all little-endian.
void write_sweeps(const std::string& path, const RecordedCase& recorded) {
  std::ofstream file(path, std::ios::binary);
  const auto put = [&file](const auto* words, std::size_t count) {
    file.write(reinterpret_cast<const char*>(words),
               static_cast<std::streamsize>(count * sizeof *words));
  };
  for (const test::RecordedSweep& sweep : test::recorded_sweeps(recorded.name, recorded.scans)) {
    const double pose[] = {sweep.odom_T_base.x_m, sweep.odom_T_base.y_m,
                           sweep.odom_T_base.theta_rad};
    const auto count = static_cast<std::uint32_t>(sweep.x_m.size());
    put(pose, 3);
    put(&count, 1);
    put(sweep.x_m.data(), sweep.x_m.size());
    put(sweep.y_m.data(), sweep.y_m.size());
  }
}

TEST(OneHash, OfRecordedLogsIsWhatEveryPlatformFinds) {
  PICOLO_NEED_IMAGES();
  PICOLO_NEED_DATA("radish/freiburg-101.clf.gz");
  PICOLO_NEED_DATA("raw2d/mines_exp1.clf.gz");
  const test::TemporaryFolder folder;
  for (const RecordedCase& recorded : kRecorded) {
    write_sweeps(sweeps_file(folder, recorded), recorded);
  }
  print_head(kRecordedNames);
  for (const Platform& platform : platforms_to_judge()) {
    Outcome both;
    both.status = 0;
    for (const RecordedCase& recorded : kRecorded) {
      const Outcome one =
          run(platform, "determinism", {"log", sweeps_file(folder, recorded), recorded.name});
      both.status = std::max(both.status, one.status);
      both.output += one.output;
      both.seconds += one.seconds;
    }
    judge(both, platform.name, kRecordedNames);
  }
}

}  // namespace
}  // namespace picolo::target
