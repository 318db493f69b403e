// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The moment at which a 32-bit count of microseconds passes its end must not be seen: whenever in
// the drive it comes, every publication stays what it was.

#include <gtest/gtest.h>

#include "drive.hpp"

namespace picolo {
namespace {

constexpr Duration kDrive = 10s;
constexpr Duration kWrap{1LL << 32};

struct DriveEnd {
  std::uint64_t hash = 0;
  Duration third_sweep_end{};  // since the start
};

DriveEnd drive_with_wrap_after(Duration elapsed) {
  const Timestamp start{kWrap - elapsed};
  test::Drive drive{hashed_drive(sim::SceneName::room, start)};
  TrajectoryHash hash{start};
  DriveEnd run;
  std::uint32_t sweeps = 0;
  drive.until(kDrive, [&](const test::Publication& publication) {
    hash.add(publication.estimate);
    const Duration end = drive.controller().pipeline().last_sweep_end() - start;
    if (drive.controller().pipeline().counters().sweeps_taken != sweeps) {
      sweeps = drive.controller().pipeline().counters().sweeps_taken;
      if (sweeps == 3) { run.third_sweep_end = end; }
    }
  });
  EXPECT_FALSE(hash.poisoned());
  run.hash = hash.value();
  return run;
}

TEST(CounterWrap, At256MomentsOfADriveChangesNothing) {
  const DriveEnd reference =
      drive_with_wrap_after(kWrap - kDrive);  // long before the end of the count
  for (int i = 0; i < 256; ++i) {
    ASSERT_EQ(drive_with_wrap_after(kDrive * (2 * i + 1) / 512).hash, reference.hash)
        << "wrap at part " << i << " of 256";
  }
}

TEST(CounterWrap, AroundTheEndOfASweepChangesNothing) {
  const DriveEnd reference = drive_with_wrap_after(kWrap - kDrive);
  ASSERT_GT(reference.third_sweep_end, Duration{0});
  for (const Duration offset :
       {Duration{-5000}, Duration{-1}, Duration{0}, Duration{1}, Duration{5000}}) {
    ASSERT_EQ(drive_with_wrap_after(reference.third_sweep_end + offset).hash, reference.hash)
        << "wrap " << offset.count() << " us after the end of a sweep";
  }
}

}  // namespace
}  // namespace picolo
