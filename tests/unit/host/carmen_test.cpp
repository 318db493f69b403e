// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/carmen.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/data.hpp"
#include "support/files.hpp"

namespace picolo {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kDegree = std::numbers::pi / 180.0;

struct Reading {
  host::CarmenLog log;
  std::vector<std::string> warnings;
};

Reading read(const std::string& path) {
  Reading reading;
  host::Diagnostics diagnostics{
      [&reading](std::string_view line) { reading.warnings.emplace_back(line); }};
  host::LineReader reader{path};
  reading.log = host::read_carmen(reader, diagnostics);
  return reading;
}

Reading read_text(const std::string& text) {
  const TemporaryFolder folder;
  return read(folder.write("drive.log", text));
}

std::string flaser(int beams, const std::string& range = "1.5") {
  std::string line = "FLASER " + std::to_string(beams);
  for (int i = 0; i < beams; ++i) { line += " " + range; }
  return line + " 9 9 9 1.0 -2.0 0.5 12.25 host 3.5\n";
}

TEST(Carmen, FlaserHasOdometryStampAndLaserAtTheBase) {
  const Reading reading = read_text("# comment\n\n" + flaser(180));
  EXPECT_THAT(reading.warnings, IsEmpty());
  ASSERT_EQ(reading.log.scans.size(), 1U);
  const host::LogScan& scan = reading.log.scans[0];
  EXPECT_EQ(scan.line, 3U);
  EXPECT_EQ(scan.stamp_s, 12.25) << "the sensor's stamp, not the logger's";
  EXPECT_EQ(scan.odom_T_base, (Pose2d{1.0, -2.0, 0.5})) << "the odometry pose, not the laser's";
  EXPECT_EQ(scan.base_T_lidar, Pose2d{});
  EXPECT_TRUE(scan.has_odometry);
  EXPECT_FALSE(scan.max_range_m.has_value());
  EXPECT_EQ(scan.ranges_m, std::vector<float>(180, 1.5F));
}

struct FlaserGeometry {
  int beams;
  double last_deg;
};
class CarmenFlaserGeometry : public ::testing::TestWithParam<FlaserGeometry> {};

TEST_P(CarmenFlaserGeometry, BeamsSpreadFromMinus90) {
  const auto [beams, last_deg] = GetParam();
  const Reading reading = read_text(flaser(beams));
  ASSERT_EQ(reading.log.scans.size(), 1U);
  const std::vector<float>& bearings = reading.log.scans[0].bearings_rad;
  ASSERT_EQ(bearings.size(), static_cast<std::size_t>(beams));
  EXPECT_NEAR(static_cast<double>(bearings.front()), -90.0 * kDegree, 1e-6);
  EXPECT_NEAR(static_cast<double>(bearings.back()), last_deg * kDegree, 1e-6);
  const double step = (last_deg + 90.0) / std::max(1, beams - 1) * kDegree;
  EXPECT_NEAR(static_cast<double>(bearings[bearings.size() / 2]),
              -90.0 * kDegree + step * static_cast<double>(bearings.size() / 2), 1e-6);
}
INSTANTIATE_TEST_SUITE_P(Counts, CarmenFlaserGeometry,
                         ::testing::Values(FlaserGeometry{180, 89.0}, FlaserGeometry{360, 89.5},
                                           FlaserGeometry{181, 90.0}, FlaserGeometry{361, 90.0},
                                           FlaserGeometry{91, 90.0}, FlaserGeometry{541, 90.0},
                                           FlaserGeometry{1, -90.0}));

TEST(Carmen, RobotlaserHasItsOwnGeometryMaximumRangeAndMounting) {
  // robot at (1, 2) looking along y, laser 0.5 m ahead of it and turned by 0.1 rad
  const Reading reading = read_text(
      "ROBOTLASER1 0 -1.5 3.0 0.75 8.5 0.01 0 3 1.0 2.0 inf 2 7 8 "
      "1 2.5 1.6707963 1 2 1.5707963 0.1 0.2 0 0 0 99.5 host 1.5\n");
  EXPECT_THAT(reading.warnings, IsEmpty());
  ASSERT_EQ(reading.log.scans.size(), 1U);
  const host::LogScan& scan = reading.log.scans[0];
  EXPECT_EQ(scan.bearings_rad, (std::vector<float>{-1.5F, -0.75F, 0.0F}));
  EXPECT_EQ(scan.ranges_m[1], 2.0F);
  EXPECT_TRUE(std::isinf(scan.ranges_m[2])) << "kept as logged, judged by whoever uses it";
  EXPECT_EQ(scan.max_range_m, 8.5);
  EXPECT_EQ(scan.stamp_s, 99.5);
  EXPECT_EQ(scan.odom_T_base, (Pose2d{1.0, 2.0, 1.5707963}));
  EXPECT_NEAR(scan.base_T_lidar.x_m, 0.5, 1e-6);
  EXPECT_NEAR(scan.base_T_lidar.y_m, 0.0, 1e-6);
  EXPECT_NEAR(scan.base_T_lidar.theta_rad, 0.1, 1e-6);
}

TEST(Carmen, OdomAndSweepLinesAreRead) {
  const Reading reading =
      read_text("ODOM 1 2 3 0.4 0.5 0 6.5 host 6.6\nSWEEP 10.5 0.25 2 11 0.1 1.0 0.2 0\n");
  EXPECT_THAT(reading.warnings, IsEmpty());
  ASSERT_EQ(reading.log.odometry.size(), 1U);
  EXPECT_EQ(reading.log.odometry[0].odom_T_base, (Pose2d{1.0, 2.0, 3.0}));
  EXPECT_EQ(reading.log.odometry[0].yaw_rate_radps, 0.5);
  EXPECT_EQ(reading.log.odometry[0].stamp_s, 6.5);
  ASSERT_EQ(reading.log.sweeps.size(), 1U);
  EXPECT_EQ(reading.log.sweeps[0].stamp_s, 10.5);
  EXPECT_EQ(reading.log.sweeps[0].time_increment_s, 0.25);
  EXPECT_EQ(reading.log.sweeps[0].received_s, 11.0);
  EXPECT_EQ(reading.log.sweeps[0].bearings_rad, (std::vector<float>{0.1F, 0.2F}));
  EXPECT_EQ(reading.log.sweeps[0].ranges_m, (std::vector<float>{1.0F, 0.0F}));
}

TEST(Carmen, UnknownKeywordsAreSilent) {
  const Reading reading = read_text("PARAM a b\nTICKS 1 2 3\nFLASERX\nODOMETER\nSYNC 1\n");
  EXPECT_THAT(reading.warnings, IsEmpty());
  EXPECT_TRUE(reading.log.scans.empty());
}

struct BadLineCase {
  const char* line;
  const char* cause;
};
class CarmenBadLine : public ::testing::TestWithParam<BadLineCase> {};

TEST_P(CarmenBadLine, IsSkippedWithFileLineAndCause) {
  const TemporaryFolder folder;
  const std::string path =
      folder.write("drive.log", flaser(2) + GetParam().line + "\n" + flaser(2));
  const Reading reading = read(path);
  EXPECT_EQ(reading.log.scans.size(), 2U) << "its neighbours are kept";
  ASSERT_EQ(reading.warnings.size(), 1U);
  EXPECT_THAT(reading.warnings[0], HasSubstr(path + ":2: "));
  EXPECT_THAT(reading.warnings[0], HasSubstr(GetParam().cause));
}
INSTANTIATE_TEST_SUITE_P(
    Kinds, CarmenBadLine,
    ::testing::Values(
        BadLineCase{"FLASER", "ends after 1"},
        BadLineCase{"FLASER x 1 1 0 0 0 0 0 0 1 h 1", "not a count"},
        BadLineCase{"FLASER -1 1 1 0 0 0 0 0 0 1 h 1", "not a count"},
        BadLineCase{"FLASER 999999999 1 1 0 0 0 0 0 0 1 h 1", "not a count"},
        BadLineCase{"FLASER 3 1 1 0 0 0 0 0 0 1 h 1", "needs 14 fields, the line has 13"},
        BadLineCase{"FLASER 1 1 1 0 0 0 0 0 0 1 h 1", "needs 12 fields, the line has 13"},
        BadLineCase{"FLASER 2 1 1.0.0 0 0 0 0 0 0 1 h 1", "not a number"},
        BadLineCase{"FLASER 2 1 1 0 0 0 nan 0 0 1 h 1", "not finite"},
        BadLineCase{"FLASER 2 1 1 0 0 0 0 0 0 1e999 h 1", "stamp"},
        BadLineCase{"ROBOTLASER1 0 -1.5 3 0 8 0 0 2 1 1 0 0 0 0 0 0 0 0 0 0 0 0 1 h 1",
                    "resolution"},
        BadLineCase{"ROBOTLASER1 0 -1.5 3 0.1 8 0 0 2 1 1 5 0 0 0 0 0 0 0 0 0 0 0 1 h 1", "needs"},
        BadLineCase{"ODOM 1 2 3 4", "needs 10 fields"},
        BadLineCase{"SWEEP 1 0.1 2 1 0 1 0", "needs 9 fields"},
        BadLineCase{"SWEEP 1 -0.1 1 1 0 1", "order of time"}));

TEST(Carmen, AFloodOfBadLinesIsSummedUp) {
  std::string text;
  for (int i = 0; i < 1000; ++i) { text += "FLASER 1\n"; }
  const Reading reading = read_text(text);
  ASSERT_EQ(reading.warnings.size(), host::Diagnostics::kShown + 1);
  EXPECT_THAT(reading.warnings.back(), HasSubstr("1000 in all"));
}

TEST(Carmen, StampsAndOdometryAreJudged) {
  const std::string a = "FLASER 1 1 0 0 0 0 0 0 1.0 h 1\n";
  const std::string b = "FLASER 1 1 0 0 0 0 0 0 2.0 h 1\n";
  const std::string moved = "FLASER 1 1 0 0 0 0.1 0 0 2.0 h 1\n";
  EXPECT_TRUE(stamps_increase(read_text(a + b).log));
  EXPECT_FALSE(stamps_increase(read_text(a + a).log));
  EXPECT_FALSE(stamps_increase(read_text(b + a).log));
  EXPECT_TRUE(odometry_never_moves(read_text(a + b).log));
  EXPECT_FALSE(odometry_never_moves(read_text(a + moved).log));
}

TEST(Carmen, RecordedLogsAreReadWhole) {
  PICOLO_NEED_DATA("raw2d/malaga_sena_loop.clf.gz");
  PICOLO_NEED_DATA("radish/freiburg-101.clf.gz");
  PICOLO_NEED_DATA("raw2d/laserazos_sm3.clf.gz");
  PICOLO_NEED_DATA("raw2d/intel_corrected_rt.clf.gz");
  const Reading malaga = read(test::data_path("raw2d/malaga_sena_loop.clf.gz").string());
  EXPECT_THAT(malaga.warnings, IsEmpty());
  ASSERT_EQ(malaga.log.scans.size(), 225U);
  EXPECT_NEAR(malaga.log.scans.back().base_T_lidar.x_m, 0.78, 2e-6);
  const Reading freiburg = read(test::data_path("radish/freiburg-101.clf.gz").string());
  EXPECT_EQ(freiburg.log.scans.size(), 292U);
  EXPECT_EQ(freiburg.log.scans[0].stamp_s, 158.415);
  EXPECT_TRUE(stamps_increase(freiburg.log));
  const Reading azos = read(test::data_path("raw2d/laserazos_sm3.clf.gz").string());
  EXPECT_THAT(azos.warnings, IsEmpty()) << "host and logger stamp are free text there";
  EXPECT_EQ(azos.log.scans.size(), 778U);
  EXPECT_FALSE(
      stamps_increase(read(test::data_path("raw2d/intel_corrected_rt.clf.gz").string()).log));
}

}  // namespace
}  // namespace picolo
