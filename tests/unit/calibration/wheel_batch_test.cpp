// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/wheel_batch.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "calib_files.hpp"
#include "picolo/calibration/wheel_walk.hpp"

namespace picolo {
namespace {

std::string printed(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

WheelReport seed_report(std::uint64_t limit) {
  const std::vector<WheelRates> rates = test::seed_rates();
  const std::vector<ScanMotion> scans = test::seed_scans();
  SpanSource<WheelRates> rate_source{rates};
  SpanSource<ScanMotion> scan_source{scans};
  WheelReport report;
  EXPECT_EQ(calibrate_wheels(rate_source, scan_source, {.limit = limit}, report), Status::ok)
      << to_string(report.refusal.reason);
  return report;
}

TEST(WheelBatch, GivesThePublishedDigitsOfTheFirst5000Rows) {
  PICOLO_NEED_DATA("calib/seed_odom.txt.gz");
  const WheelReport report = seed_report(5000);
  EXPECT_EQ(report.used, 5000U);
  EXPECT_EQ(printed(report.j21.value), "-0.163886");
  EXPECT_EQ(printed(report.j22.value), "0.170575");
  EXPECT_EQ(printed(report.track_m.value), "0.59796");
  EXPECT_EQ(printed(report.radius_left_m.value), "0.0979974");
  EXPECT_EQ(printed(report.radius_right_m.value), "0.101997");
  EXPECT_NEAR(report.j21.value, -0.163886154672047, 1e-12);
  EXPECT_NEAR(report.track_m.value, 0.59796015288722, 1e-12);
}

TEST(WheelBatch, GivesThePublishedDigitsOfAllRows) {
  PICOLO_NEED_DATA("calib/seed_odom.txt.gz");
  const WheelReport report = seed_report(0);
  EXPECT_EQ(printed(report.j21.value), "-0.163881");
  EXPECT_EQ(printed(report.j22.value), "0.17057");
  EXPECT_EQ(printed(report.track_m.value), "0.597981");
  EXPECT_EQ(printed(report.radius_left_m.value), "0.0979978");
  EXPECT_EQ(printed(report.radius_right_m.value), "0.101998");
}

TEST(WheelBatch, GivesThePublishedDigitsOfShortPrefixes) {
  PICOLO_NEED_DATA("calib/seed_odom.txt.gz");
  const WheelReport hundred = seed_report(100);
  EXPECT_EQ(printed(hundred.j21.value), "-0.163787");
  EXPECT_EQ(printed(hundred.j22.value), "0.170473");
  EXPECT_EQ(printed(hundred.track_m.value), "0.597881");
  const WheelReport thousand = seed_report(1000);
  EXPECT_EQ(printed(thousand.j21.value), "-0.163879");
  EXPECT_EQ(printed(thousand.j22.value), "0.170568");
  EXPECT_EQ(printed(thousand.track_m.value), "0.597873");
}

TEST(WheelWalk, TheRowThatPassesTheStampClosesTheIntervalAndIsConsumed) {
  const std::vector<WheelRates> rates{{0.0, 9, 9}, {0.4, 1, 2}, {1.1, 3, 4},
                                      {1.6, 5, 6}, {2.0, 7, 8}, {2.5, 0, 0}};
  const std::vector<ScanMotion> scans{{1.0, {}}, {2.0, {}}, {3.0, {}}};
  SpanSource<WheelRates> rate_source{rates};
  SpanSource<ScanMotion> scan_source{scans};
  WheelWalk walk{rate_source, scan_source};
  walk.rewind(0);
  WheelStretch stretch;
  ScanMotion scan;
  const double durations[] = {0.4, 0.6, 0.6, 0.4, 0.5};
  const double lefts[] = {1, 3, 5, 7, 0};
  const bool closes[] = {false, true, false, true, false};
  const double stamps[] = {1, 1, 2, 2, 3};
  for (std::size_t k = 0; k < 5; ++k) {
    ASSERT_TRUE(walk.next(stretch, scan));
    EXPECT_NEAR(stretch.duration_s, durations[k], 1e-12);
    EXPECT_EQ(stretch.left_radps, lefts[k]);
    EXPECT_EQ(stretch.closes, closes[k]);
    EXPECT_EQ(scan.stamp_s, stamps[k]);
  }
  EXPECT_FALSE(walk.next(stretch, scan));
  walk.rewind(1);
  EXPECT_TRUE(walk.next(stretch, scan));
  EXPECT_TRUE(walk.next(stretch, scan));
  EXPECT_FALSE(walk.next(stretch, scan)) << "the limit of scans is reached";
}

TEST(WheelBatch, EmptySourcesAreRefused) {
  SpanSource<WheelRates> rates{{}};
  SpanSource<ScanMotion> scans{{}};
  WheelReport report;
  EXPECT_EQ(calibrate_wheels(rates, scans, {}, report), Status::degenerate);
  EXPECT_EQ(report.refusal.reason, RefusalReason::too_little_data);
  EXPECT_EQ(calibrate_wheels(rates, scans, {.max_relative_std = 0.0}, report),
            Status::invalid_argument);
}

}  // namespace
}  // namespace picolo
