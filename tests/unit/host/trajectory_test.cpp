// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/trajectory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "picolo/host/ape.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/quantile.hpp"
#include "support/data.hpp"
#include "support/files.hpp"

namespace picolo {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

host::TumFile read(const std::string& path, std::vector<std::string>* warnings = nullptr) {
  host::Diagnostics diagnostics{[&](std::string_view line) {
    if (warnings != nullptr) { warnings->emplace_back(line); }
  }};
  host::LineReader reader{path};
  return host::read_tum(reader, diagnostics);
}

host::Trajectory circle(int count) {
  host::Trajectory poses;
  for (int i = 0; i < count; ++i) {
    const double angle = 0.05 * i;
    poses.push_back({976053557.767368 + 0.1 * i,
                     {3.0 * std::cos(angle), 3.0 * std::sin(angle), std::remainder(angle, 6.28)}});
  }
  return poses;
}

TEST(Tum, RoundTripKeepsStampsToTheMicrosecondAndPosesToTheNanometre) {
  const TemporaryFolder folder;
  const host::Trajectory poses = circle(200);
  write_tum(folder.file("a.tum"), poses);
  const host::TumFile back = read(folder.file("a.tum"));
  ASSERT_EQ(back.poses.size(), poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(back.poses[i].stamp_s, poses[i].stamp_s, 1e-6);
    EXPECT_NEAR(back.poses[i].pose.x_m, poses[i].pose.x_m, 1e-9);
    EXPECT_NEAR(back.poses[i].pose.y_m, poses[i].pose.y_m, 1e-9);
    EXPECT_NEAR(back.poses[i].pose.theta_rad, poses[i].pose.theta_rad, 1e-8);
  }
}

TEST(Tum, LinesAreFixedNotation) {
  const TemporaryFolder folder;
  write_tum(folder.file("a.tum"), host::Trajectory{{0.5, {1e-7, -2.0, std::numbers::pi / 2}}});
  EXPECT_EQ(test::content_of(folder.file("a.tum")),
            "0.500000 0.000000100 -2.000000000 0 0 0 0.707106781 0.707106781\n");
}

TEST(Tum, CommentsAreSkippedAndBadLinesNamed) {
  const TemporaryFolder folder;
  std::vector<std::string> warnings;
  const host::TumFile file = read(
      folder.write_gz("a.tum.gz",
                      "# head\n1 2 3 0 0 0 0 1 # end\n1 2 3\n2 0 0 0 0 0 0 0\n3 1 1 0 0 0 1 0\n"),
      &warnings);
  ASSERT_EQ(file.poses.size(), 2U);
  EXPECT_EQ(file.poses[0].pose, (Pose2d{2.0, 3.0, 0.0}));
  EXPECT_NEAR(std::abs(file.poses[1].pose.theta_rad), std::numbers::pi, 1e-12);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_THAT(warnings[0], HasSubstr("a.tum.gz:3: "));
  EXPECT_THAT(warnings[1], HasSubstr("a.tum.gz:4: quaternion"));
}

TEST(Tum, AFileWithoutAPoseIsRefused) {
  const TemporaryFolder folder;
  EXPECT_THROW((void)read(folder.write("a.tum", "# nothing\n")), host::UserError);
}

TEST(Kitti, ALineIsTheUpperThreeRowsOfTheTransform) {
  const TemporaryFolder folder;
  write_kitti(folder.file("a.txt"), host::Trajectory{{0.0, {1.0, 2.0, std::numbers::pi / 2}}});
  EXPECT_EQ(test::content_of(folder.file("a.txt")),
            "0.000000000 -1.000000000 0 1.000000000 1.000000000 0.000000000 0 2.000000000 "
            "0 0 1 0\n");
}

TEST(WriteFile, AFolderThatDoesNotExistIsAUsageError) {
  const TemporaryFolder folder;
  try {
    write_tum(folder.file("no/such/a.tum"), circle(1));
    FAIL();
  } catch (const host::UserError& error) {
    EXPECT_EQ(error.code(), host::ExitCode::usage);
    EXPECT_THAT(error.what(), HasSubstr("--out"));
  }
}

TEST(Ape, AMovedCopyHasNoErrorAndTheAlignmentIsTheMove) {
  const host::Trajectory reference = circle(100);
  const Pose2d estimate_T_reference{4.0, -1.0, 2.5};
  const host::ApeSummary ape =
      evaluate_ape(reference, host::transformed(estimate_T_reference, reference));
  EXPECT_EQ(ape.statistics.count, 100U);
  EXPECT_NEAR(ape.statistics.max, 0.0, 1e-9);
  const Pose2d identity = ape.reference_T_estimate * estimate_T_reference;
  EXPECT_NEAR(identity.x_m, 0.0, 1e-9);
  EXPECT_NEAR(identity.theta_rad, 0.0, 1e-9);
}

TEST(Ape, OnlyPosesCloseInTimeAreCompared) {
  const host::Trajectory reference = circle(50);
  host::Trajectory estimate = circle(50);
  for (std::size_t i = 0; i < 25; ++i) { estimate[i].stamp_s += 0.05; }
  EXPECT_EQ(evaluate_ape(reference, estimate).statistics.count, 25U);
  EXPECT_EQ(evaluate_ape(reference, estimate, 0.06).statistics.count, 50U);
}

TEST(Ape, StampsThatRunBackwardsAreComparedInTheOrderOfTime) {
  const host::Trajectory reference = circle(50);
  const host::Trajectory backwards{reference.rbegin(), reference.rend()};
  const host::ApeSummary ape = evaluate_ape(reference, backwards);
  EXPECT_EQ(ape.statistics.count, 50U);
  EXPECT_NEAR(ape.statistics.max, 0.0, 1e-9);
}

TEST(Ape, NothingInCommonGivesNullsAndZeroPairs) {
  const host::Trajectory reference = circle(3);
  const host::ApeSummary ape = evaluate_ape(reference, host::Trajectory{{5.0, {}}});
  EXPECT_EQ(host::to_text(to_json(ape)),
            R"({"rmse":null,"mean":null,"median":null,"max":null,"pairs":0})");
}

TEST(Ape, AVehicleThatStoodStillIsComparedAtItsFirstPose) {
  const host::Trajectory still{{1.0, {1.0, 1.0, 0.5}}, {2.0, {1.0, 1.0, 0.5}}};
  const host::Trajectory other{{1.0, {7.0, 1.0, 0.0}}, {2.0, {7.0, 2.0, 0.0}}};
  const host::ApeSummary ape = evaluate_ape(still, other);
  EXPECT_EQ(ape.statistics.count, 2U);
  EXPECT_NEAR(ape.statistics.max, 1.0, 1e-9);
}

TEST(Quantile, IsTheNearestRank) {
  EXPECT_EQ(host::quantile({}, 0.5), 0.0);
  EXPECT_EQ(host::quantile({3.0}, 0.99), 3.0);
  EXPECT_EQ(host::quantile({4.0, 1.0, 3.0, 2.0}, 0.5), 2.0);
  EXPECT_EQ(host::quantile({4.0, 1.0, 3.0, 2.0}, 0.51), 3.0);
  std::vector<double> hundred;
  for (int i = 1; i <= 100; ++i) { hundred.push_back(i); }
  EXPECT_EQ(host::quantile(hundred, 0.99), 99.0);
  EXPECT_EQ(host::quantile(hundred, 1.0), 100.0);
}

}  // namespace
}  // namespace picolo
