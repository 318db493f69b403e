// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The recorded outputs: one number for every pose and the final map of a drive, the same on every
// platform, compiler and optimisation level. A changed number is committed on purpose, with its
// reason in the message; this test prints the line to commit.

#include <gtest/gtest.h>

#include <fstream>
#include <iomanip>
#include <map>
#include <memory>
#include <sstream>
#include <string>

#include "drive.hpp"
#include "recorded_sweeps.hpp"

namespace picolo {
namespace {

std::string hex(std::uint64_t value) {
  std::ostringstream text;
  text << std::hex << std::setw(16) << std::setfill('0') << value;
  return text.str();
}

std::map<std::string, std::string> committed_hashes() {
  std::map<std::string, std::string> hashes;
  std::ifstream file(test::source_dir() / "tests/integration/hashes/hashes.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string name;
    std::string value;
    if (words >> name >> value && name[0] != '#') { hashes[name] = value; }
  }
  return hashes;
}

void expect_committed(const std::string& name, std::uint64_t hash) {
  const auto hashes = committed_hashes();
  const auto found = hashes.find(name);
  EXPECT_EQ(found == hashes.end() ? "(none)" : found->second, hex(hash))
      << "tests/integration/hashes/hashes.txt: to change it on purpose, write\n"
      << name << ' ' << hex(hash);
}

class SimulatedHash : public ::testing::TestWithParam<std::pair<const char*, sim::SceneName>> {};

TEST_P(SimulatedHash, EqualsTheCommittedOne) {
  const sim::SimulationConfig simulation = hashed_drive(GetParam().second);
  test::Drive drive{simulation};
  TrajectoryHash hash{simulation.start};
  drive.until(kHashedDrive,
              [&](const test::Publication& publication) { hash.add(publication.estimate); });
  EXPECT_FALSE(hash.poisoned());
  expect_committed(std::string{"sim/"} + GetParam().first,
                   whole_hash(hash, drive.controller().pipeline().localiser().map()));
}

INSTANTIATE_TEST_SUITE_P(Scenes, SimulatedHash,
                         ::testing::Values(std::pair{"office", sim::SceneName::office},
                                           std::pair{"corridor", sim::SceneName::corridor},
                                           std::pair{"hall", sim::SceneName::hall}),
                         [](const auto& drive_info) {
                           return std::string{drive_info.param.first};
                         });

/// The first `scans` of a recorded log through the localiser.
std::uint64_t hash_of_log(const std::string& name, std::size_t scans) {
  auto localiser = std::make_unique<Localiser<HallProfile>>();
  Hash hash;
  for (const test::RecordedSweep& recorded : test::recorded_sweeps(name, scans)) {
    UndistortedSweep sweep;
    sweep.odom_T_base = recorded.odom_T_base;
    sweep.points = {recorded.x_m, recorded.y_m};
    EXPECT_EQ(localiser->core().process(sweep, true), Status::ok);
    const Pose2d& pose = localiser->core().map_T_base();
    hash.add(pose.x_m);
    hash.add(pose.y_m);
    hash.add(pose.theta_rad);
  }
  add_map(localiser->core().map(), hash);
  EXPECT_FALSE(hash.poisoned());
  return hash.value();
}

class RecordedHash : public ::testing::TestWithParam<std::pair<const char*, std::size_t>> {};

TEST_P(RecordedHash, EqualsTheCommittedOne) {
  const std::string name = GetParam().first;
  PICOLO_NEED_DATA(name + ".clf.gz");
  expect_committed(name, hash_of_log(name, GetParam().second));
}

INSTANTIATE_TEST_SUITE_P(Logs, RecordedHash,
                         ::testing::Values(std::pair{"radish/freiburg-101", std::size_t{292}},
                                           std::pair{"radish/freiburg-079", std::size_t{600}},
                                           std::pair{"radish/intel", std::size_t{400}},
                                           std::pair{"raw2d/mines_exp1", std::size_t{300}}),
                         [](const auto& drive_info) {
                           std::string name{drive_info.param.first};
                           std::replace_if(
                               name.begin(), name.end(),
                               [](char c) { return c == '/' || c == '-'; }, '_');
                           return name;
                         });

}  // namespace
}  // namespace picolo
