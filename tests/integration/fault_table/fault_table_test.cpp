// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Seven kinds of fault on five sensors, at 20 random instants while moving, on simulated and
// recorded drives: the table of docs/faults.md.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#include "matrix.hpp"
#include "picolo/host/diagnostics.hpp"
#include "recorded_subject.hpp"
#include "simulated_subject.hpp"
#include "support/data.hpp"

namespace picolo::test {
namespace {

constexpr std::uint64_t kSeed = 401;  // no limit was ever set with a look at these drives

/// PICOLO_CAMPAIGN multiplies them.
int instants() {
  const char* factor = std::getenv("PICOLO_CAMPAIGN");
  return 20 * std::max(1, factor == nullptr ? 1 : std::atoi(factor));
}

/// Another seed: other drives, other instants.
std::uint64_t first_seed() {
  const char* seed = std::getenv("PICOLO_FAULT_SEED");
  return seed == nullptr ? kSeed : static_cast<std::uint64_t>(std::atoll(seed));
}

TEST(FaultTable, OnSimulatedDrives) {
  Campaign campaign{
      .sensors = {Sensor::left_wheel, Sensor::right_wheel, Sensor::lidar, Sensor::gyro}};
  Campaign leaning{.sensors = {Sensor::accelerometer}, .leans = true};
  constexpr std::array kScenes{sim::SceneName::office, sim::SceneName::room, sim::SceneName::office,
                               sim::SceneName::room};
  const int per_drive = instants() / static_cast<int>(kScenes.size());
  for (std::size_t k = 0; k < kScenes.size(); ++k) {
    const std::uint64_t seed = first_seed() + k;
    const auto subject = std::make_unique<SimulatedSubject>(kScenes[k], seed);
    campaign.drive(*subject, seed, per_drive, Timestamp{8s}, Timestamp{100s});
    const auto again = std::make_unique<SimulatedSubject>(kScenes[k], seed);
    leaning.drive(*again, seed, per_drive, Timestamp{8s}, Timestamp{100s});
  }
  campaign.print("simulated");
  EXPECT_EQ(campaign.count(Verdict::silent), 0);
  EXPECT_LE(200 * campaign.count(Verdict::late), static_cast<int>(campaign.outcomes.size()));
  EXPECT_EQ(campaign.nominal.alarms, 0);
  leaning.print("simulated, leaning by 15 deg for 2 s of the fault");
  EXPECT_EQ(leaning.count(Verdict::silent), 0);
  EXPECT_EQ(leaning.count(Verdict::late), 0);
}

host::CarmenLog read_log(const std::string& name) {
  host::LineReader reader{data_path(name)};
  host::Diagnostics quiet{[](std::string_view) {}};
  return host::read_carmen(reader, quiet);
}

host::Trajectory read_trajectory(const std::string& name) {
  host::LineReader reader{data_path(name)};
  host::Diagnostics quiet{[](std::string_view) {}};
  return host::read_tum(reader, quiet).poses;
}

struct RecordedDrive {
  const char* name;
  Duration scan_period;
  const char* reference = nullptr;  ///< whose headings the gyro tells; no gyro otherwise
  bool good_wheels = false;         ///< that went the reference's way, not the odometry's
};

class RecordedFaultTable : public ::testing::TestWithParam<RecordedDrive> {};

TEST_P(RecordedFaultTable, Table) {
  const RecordedDrive& drive = GetParam();
  PICOLO_NEED_DATA(drive.name);
  Campaign campaign{.sensors = {Sensor::left_wheel, Sensor::right_wheel, Sensor::lidar},
                    .lidar_period = drive.scan_period};
  const host::CarmenLog log = read_log(drive.name);
  LogTrack track{log};
  std::string title = drive.name;
  if (drive.reference != nullptr) {
    PICOLO_NEED_DATA(drive.reference);
    const host::Trajectory reference = read_trajectory(drive.reference);
    track.take_gyro_from(reference);
    if (drive.good_wheels) { track.take_wheels_from(reference); }
    campaign.sensors.push_back(Sensor::gyro);
    title += drive.good_wheels ? ", wheels and gyro of its reference" : " and a gyro";
  }
  const auto subject = std::make_unique<RecordedSubject>(track, drive.scan_period);
  campaign.drive(*subject, first_seed(), instants(), Timestamp{4s}, track.end() - 9s);
  campaign.print(title);
  EXPECT_EQ(campaign.count(Verdict::silent), 0);
  EXPECT_LE(50 * campaign.count(Verdict::late), static_cast<int>(campaign.outcomes.size()));
}

constexpr const char* kFreiburg = "radish/freiburg-079.clf.gz";
constexpr const char* kFreiburgReference = "radish/freiburg-079_ref.tum.gz";

INSTANTIATE_TEST_SUITE_P(Logs, RecordedFaultTable,
                         ::testing::Values(RecordedDrive{"imu/undistort_sweeps_a.txt.gz", 90ms},
                                           RecordedDrive{kFreiburg, 235ms},
                                           RecordedDrive{kFreiburg, 235ms, kFreiburgReference},
                                           RecordedDrive{kFreiburg, 235ms, kFreiburgReference,
                                                         true}));

}  // namespace
}  // namespace picolo::test
