// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Two runs are the same run, wherever the clocks stand.

#include <gtest/gtest.h>

#include "drive.hpp"

namespace picolo {
namespace {

using sim::SceneName;
using test::Drive;
using test::Publication;

std::uint64_t hash_of_drive(sim::SimulationConfig simulation, Duration length) {
  Drive drive{simulation};
  TrajectoryHash hash{simulation.start};
  drive.until(length, [&](const Publication& publication) { hash.add(publication.estimate); });
  return hash.value();
}

TEST(Determinism, GivenTheSameSeedThenEveryPublicationIsTheSame) {
  const sim::SimulationConfig simulation = test::drive_in(SceneName::office);
  const std::uint64_t first = hash_of_drive(simulation, 20s);
  EXPECT_EQ(hash_of_drive(simulation, 20s), first);
  sim::SimulationConfig other = simulation;
  other.seed += 1;
  EXPECT_NE(hash_of_drive(other, 20s), first) << "the hash sees the noise";
}

TEST(Determinism, GivenClocksThatPass32BitsOnTheWayThenNothingChanges) {
  sim::SimulationConfig simulation = test::drive_in(SceneName::room);
  const std::uint64_t from_zero = hash_of_drive(simulation, 10s);
  simulation.start =
      Timestamp{Duration{(1LL << 32) - 5'000'000}};  // 2^32 us in the middle of the drive
  EXPECT_EQ(hash_of_drive(simulation, 10s), from_zero);
  simulation.start = Timestamp{Duration{365LL * 24 * 3600 * 1'000'000}};  // after a year of uptime
  EXPECT_EQ(hash_of_drive(simulation, 10s), from_zero);
}

}  // namespace
}  // namespace picolo
