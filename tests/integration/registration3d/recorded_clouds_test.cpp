// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Poses between recorded clouds with known answers: the Newer College features and the small_gicp
// pair.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <string>

#include "clouds.hpp"
#include "picolo/host/lidar_scans3.hpp"
#include "support/data.hpp"

namespace picolo {
namespace {

std::vector<Pose3d> newer_poses() {
  std::ifstream graph{test::data_path("lidar3d/newer_01_features/graph.txt")};
  std::vector<Pose3d> poses;
  std::string name;
  Pose3d pose;
  while (graph >> name >> pose.translation_m.x >> pose.translation_m.y >> pose.translation_m.z >>
         pose.rotation.x >> pose.rotation.y >> pose.rotation.z >> pose.rotation.w) {
    pose.rotation = normalised(pose.rotation);
    poses.push_back(pose);
  }
  return poses;
}

test::Cloud newer_cloud(const std::string& kind, std::size_t frame) {
  const std::string number = std::to_string(10 * frame);
  const std::string name = kind + "_" + std::string(6 - number.size(), '0') + number + ".bin";
  return host::read_float_points(test::data_path("lidar3d/newer_01_features/" + name), 3);
}

TEST(RecordedClouds, GivenNewerCollegeFeaturesThenThePosesBetweenFramesComeOut) {
  PICOLO_NEED_DATA("lidar3d/newer_01_features/graph.txt");
  const auto poses = newer_poses();
  ASSERT_EQ(poses.size(), 5U);
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const Pose3f found =
        test::registered(newer_cloud("edges", k), newer_cloud("planes", k),
                         newer_cloud("edges", k + 1), newer_cloud("planes", k + 1));
    const auto error = test::error_of(found, between(poses[k], poses[k + 1]));
    EXPECT_LE(error.distance_m, 0.05) << "frame " << k;
    EXPECT_LE(error.angle_deg, 0.5) << "frame " << k;
    std::printf("frame %zu: %.4f m, %.3f deg\n", k, error.distance_m, error.angle_deg);
  }
}

TEST(RecordedClouds, GivenTheSmallGicpPairThenItsTransformComesOut) {
  PICOLO_NEED_DATA("lidar3d/small_gicp_pair/T_target_source.txt");
  std::ifstream file{test::data_path("lidar3d/small_gicp_pair/T_target_source.txt")};
  std::array<double, 12> m{};
  for (double& entry : m) { file >> entry; }
  const Pose3d truth =
      to_pose({{{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}}, {m[3], m[7], m[11]}});
  const auto target = host::read_ply(test::data_path("lidar3d/small_gicp_pair/target.ply"));
  const auto source = host::read_ply(test::data_path("lidar3d/small_gicp_pair/source.ply"));
  ASSERT_EQ(target.size(), 69088U);
  const auto error = test::error_of(test::registered({}, target, {}, source), truth);
  std::printf("small_gicp pair: %.4f m, %.3f deg\n", error.distance_m, error.angle_deg);
  EXPECT_LE(error.distance_m, 0.02);
  EXPECT_LE(error.angle_deg, 0.3);
}

}  // namespace
}  // namespace picolo
