// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/spatial_trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "picolo/evaluation/pose_error.hpp"
#include "picolo/host/chart.hpp"
#include "picolo/host/error.hpp"
#include "support/files.hpp"

namespace picolo {
namespace {

using host::TrajectoryFormat;
using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::SizeIs;

host::SpatialTrajectory read(const std::string& path,
                             std::vector<std::string>* warnings = nullptr) {
  host::Diagnostics diagnostics{[&](std::string_view line) {
    if (warnings != nullptr) { warnings->emplace_back(line); }
  }};
  host::LineReader reader{path};
  return read_spatial_trajectory(reader, diagnostics);
}

host::SpatialTrajectory spiral(int count) {
  host::SpatialTrajectory result;
  for (int i = 0; i < count; ++i) {
    const double s = 0.1 * i;
    result.stamps_s.push_back(1311868164.25 + s);
    result.poses.push_back(to_transform(
        Pose3d{exp_so3(Vector3d{0.3 * s, -0.2, s}), {std::cos(s), std::sin(s), 0.1 * s}}));
  }
  return result;
}

TEST(SpatialTrajectory, GivenEachFormatWhenWrittenAndReadThenThePosesAreTheSame) {
  const TemporaryFolder folder;
  const auto trajectory = spiral(50);
  for (const auto format :
       {TrajectoryFormat::tum, TrajectoryFormat::kitti, TrajectoryFormat::euroc}) {
    write_spatial_trajectory(folder.file("t.txt"), trajectory, format);
    const auto back = read(folder.file("t.txt"));
    EXPECT_EQ(back.format, format);
    ASSERT_THAT(back.poses, SizeIs(50));
    ASSERT_THAT(back.stamps_s, SizeIs(format == TrajectoryFormat::kitti ? 0 : 50));
    for (std::size_t i = 0; i < 50; ++i) {
      EXPECT_LT(absolute_error(trajectory.poses[i], back.poses[i], PoseRelation::full), 1e-8);
      if (!back.stamps_s.empty()) { EXPECT_NEAR(back.stamps_s[i], trajectory.stamps_s[i], 1e-6); }
    }
  }
}

TEST(SpatialTrajectory, GivenAPackedFileWithCommentsThenItIsRead) {
  const TemporaryFolder folder;
  const auto path =
      folder.write_gz("t.gz", "# a comment\n\n2 1 2 3 0 0 0 1 # behind\n1 0 0 0 0 0 0 1\n");
  const auto back = read(path);
  ASSERT_THAT(back.poses, SizeIs(2));
  EXPECT_EQ(back.stamps_s, (std::vector<double>{1, 2}));  // put in order
  EXPECT_EQ(back.poses[1].translation_m, (Vector3d{1, 2, 3}));
}

TEST(SpatialTrajectory, GivenBadLinesThenTheyAreSkippedWithTheirCause) {
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  const auto path =
      folder.write("t.txt", "1 0 0 0 0 0 0 1\n2 0 0 0 0 0 0 9\n3 0 0\n4 x 0 0 0 0 0 1\n");
  EXPECT_THAT(read(path, &warnings).poses, SizeIs(1));
  ASSERT_THAT(warnings, SizeIs(3));
  EXPECT_THAT(warnings[0], HasSubstr("t.txt:2"));
  EXPECT_THAT(warnings[0], HasSubstr("squared length 81"));
  EXPECT_THAT(warnings[2], HasSubstr("t.txt:4"));
}

TEST(SpatialTrajectory, GivenNoTrajectoryThenTheErrorNamesFileCauseAndCure) {
  const TemporaryFolder folder;
  for (const std::string content : {"1 2 3\n", "# nothing\n"}) {
    const auto path = folder.write("t.txt", content);
    try {
      (void)read(path);
      FAIL();
    } catch (const host::UserError& error) {
      EXPECT_EQ(error.code(), host::ExitCode::input);
      EXPECT_THAT(error.what(), HasSubstr(path));
      EXPECT_THAT(error.what(), HasSubstr("TUM"));
    }
  }
}

TEST(SpatialTrajectory, GivenNoStampsWhenWrittenAsTumThenPosesAreCounted) {
  const TemporaryFolder folder;
  auto trajectory = spiral(3);
  trajectory.stamps_s.clear();
  write_spatial_trajectory(folder.file("t.txt"), trajectory, TrajectoryFormat::tum);
  EXPECT_EQ(read(folder.file("t.txt")).stamps_s, (std::vector<double>{0, 1, 2}));
}

TEST(Chart, GivenCurvesThenSvgNamesThemAndPngIsOne) {
  const TemporaryFolder folder;
  host::Chart chart{"A title", "a note", "time [s]", {}};
  const std::vector<double> x{0, 1, 2, 3};
  chart.panels.push_back(
      {"error [m]", {{x, {0, 1, std::nan(""), 2}, host::palette::kInk, 2.0, "first"}}});
  chart.panels.push_back({"flat", {{x, {5, 5, 5, 5}, host::palette::kOdometry, 2.0, "second"}}});
  chart.panels.push_back(
      {"rounding", {{x, {0.5, 0.5 + 1e-16, 0.5 + 2e-16, 0.5}, host::palette::kInk, 2.0, ""}}});
  chart.panels.push_back({"empty", {}});
  write_chart(chart, folder.path(), "c");
  const std::string svg = test::content_of(folder.path() / "c.svg");
  for (const char* word :
       {"A title", "a note", "time [s]", "error [m]", "first", "second", "<svg"}) {
    EXPECT_THAT(svg, HasSubstr(word));
  }
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_THAT(test::content_of(folder.path() / "c.png"), HasSubstr("PNG"));
}

}  // namespace
}  // namespace picolo
