// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/data.hpp"
#include "tool_run.hpp"

namespace picolo {
namespace {

using test::run_tool;
using test::TemporaryFolder;
using ::testing::HasSubstr;

TEST(Odometry3d, GivenTheKittiTownThenItFollowsTheReferenceWithoutHeap) {
  PICOLO_NEED_DATA("lidar3d/kitti_0005_r16.l3d.gz");
  const TemporaryFolder folder;
  const auto run =
      run_tool(folder, {"odometry3d", test::data_path("lidar3d/kitti_0005_r16.l3d.gz").string(),
                        "--out", "out", "--json", "--reference",
                        test::data_path("lidar3d/kitti_0005_ref_gicp64.kitti.txt").string()});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto json = run.json();
  EXPECT_EQ(json["scans"], 154);  // the incomplete last one included
  EXPECT_LE(json["ape_m"].get<double>(), 0.06);
  EXPECT_LE(json["ape_se3_m"].get<double>(), 0.03);
  EXPECT_LE(json["rpe10_m"].get<double>(), 0.05);
  EXPECT_LE(json["rpe10_deg"].get<double>(), 0.3);
  EXPECT_EQ(json["heap_calls"], 0);
  EXPECT_LE(json["memory_bytes"].get<int>(), 800 * 1024);
  EXPECT_LE(json["memory_bytes"].get<int>() - json["map_bytes"].get<int>(), 300 * 1024);
  EXPECT_EQ(json["skipped_rings"], 0);
  for (const char* name :
       {"trajectory.tum", "trajectory.kitti", "odometry3d.png", "odometry3d.svg"}) {
    EXPECT_GT(std::filesystem::file_size(folder.path() / "out" / name), 1000U);
  }
}

TEST(Odometry3d, GivenNoScansThenTheErrorSaysSo) {
  const TemporaryFolder folder;
  const auto run =
      run_tool(folder, {"odometry3d", folder.write("x.l3d", "nothing at all, really")});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.err, HasSubstr("x.l3d"));
}

}  // namespace
}  // namespace picolo
