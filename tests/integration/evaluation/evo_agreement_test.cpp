// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The 36 results that evo itself gave for its own example trajectories, to the last digits that
// rounding leaves.

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "picolo/evaluation/alignment.hpp"
#include "picolo/evaluation/association.hpp"
#include "picolo/evaluation/delta_pairs.hpp"
#include "picolo/evaluation/pose_error.hpp"
#include "picolo/evaluation/statistics.hpp"
#include "support/data.hpp"

namespace picolo {
namespace {

struct Trajectory {
  std::vector<double> stamps_s;
  std::vector<Transform3d> poses;
};

std::vector<std::vector<double>> rows_of(const std::string& name) {
  gzFile file = gzopen(test::data_path(name).c_str(), "rb");
  std::vector<std::vector<double>> rows;
  std::array<char, 4096> line{};
  while (file != nullptr && gzgets(file, line.data(), static_cast<int>(line.size())) != nullptr) {
    if (line[0] == '#') { continue; }
    std::istringstream words{line.data()};
    std::vector<double> row;
    for (double value{}; words >> value;) { row.push_back(value); }
    if (!row.empty()) { rows.push_back(row); }
  }
  gzclose(file);
  return rows;
}

Trajectory read_tum(const std::string& name) {
  Trajectory result;
  for (const auto& row : rows_of(name)) {
    result.stamps_s.push_back(row.at(0));
    const Quaterniond q{row.at(7), row.at(4), row.at(5), row.at(6)};
    result.poses.push_back({to_matrix(q), {row.at(1), row.at(2), row.at(3)}});
  }
  return result;
}

Trajectory read_kitti(const std::string& name) {
  Trajectory result;
  for (const auto& r : rows_of(name)) {
    const Matrix3d m{
        {r.at(0), r.at(1), r.at(2), r.at(4), r.at(5), r.at(6), r.at(8), r.at(9), r.at(10)}};
    result.poses.push_back({m, {r.at(3), r.at(7), r.at(11)}});
  }
  return result;
}

struct Pair {
  std::vector<Transform3d> reference;
  std::vector<Transform3d> estimate;
};

Pair associated(const Trajectory& reference, const Trajectory& estimate) {
  std::vector<IndexPair> pairs(std::min(reference.poses.size(), estimate.poses.size()));
  const auto count = associate(reference.stamps_s, estimate.stamps_s, 0.01, 0.0, pairs);
  EXPECT_TRUE(count);
  pairs.resize(*count);
  Pair result;
  for (const auto [r, e] : pairs) {
    result.reference.push_back(reference.poses[r]);
    result.estimate.push_back(estimate.poses[e]);
  }
  return result;
}

Pair load(const std::string& name) {
  if (name.starts_with("KITTI")) {
    return {read_kitti("evaluation/KITTI_00_gt.txt.gz").poses,
            read_kitti("evaluation/KITTI_00_ORB.txt.gz").poses};
  }
  return associated(read_tum("evaluation/fr2_desk_groundtruth.txt.gz"),
                    read_tum("evaluation/fr2_desk_ORB.txt.gz"));
}

const std::map<std::string, PoseRelation> kRelations{
    {"translation_part", PoseRelation::translation},
    {"full_transformation", PoseRelation::full},
    {"rotation_angle_deg", PoseRelation::rotation_deg}};
const std::map<std::string, AlignmentKind> kAlignments{
    {"none", AlignmentKind::none}, {"se3", AlignmentKind::se3}, {"sim3", AlignmentKind::sim3}};
const std::map<std::string, DeltaUnit> kUnits{
    {"frames", DeltaUnit::frames}, {"meters", DeltaUnit::metres}, {"degrees", DeltaUnit::degrees}};

std::vector<double> errors_of(const nlohmann::json& expected, Pair poses) {
  const auto alignment = find_alignment(poses.reference, poses.estimate,
                                        kAlignments.at(expected["align"].get<std::string>()));
  EXPECT_TRUE(alignment);
  if (expected["align"] != "none") { align(*alignment, poses.estimate); }
  const PoseRelation relation = kRelations.at(expected["relation"].get<std::string>());
  if (expected["metric"] == "ape") {
    std::vector<double> errors(poses.reference.size());
    EXPECT_EQ(absolute_errors(poses.reference, poses.estimate, relation, errors), Status::ok);
    return errors;
  }
  const DeltaConfig config{.delta = expected["delta"].get<double>(),
                           .unit = kUnits.at(expected["unit"].get<std::string>()),
                           .all_pairs = expected["all_pairs"].get<bool>()};
  std::vector<double> path_m(poses.estimate.size());
  std::vector<IndexPair> pairs(poses.estimate.size());
  const auto count = select_pairs(poses.estimate, config, path_m, pairs);
  EXPECT_TRUE(count);
  pairs.resize(*count);
  std::vector<double> errors(pairs.size());
  EXPECT_EQ(relative_errors(poses.reference, poses.estimate, pairs, relation, errors), Status::ok);
  return errors;
}

TEST(EvoAgreement, GivenEvosExamplesWhenEvaluatedThenEveryFigureAgrees) {
  PICOLO_NEED_DATA("evaluation/evo_expected.json");
  const auto cases =
      nlohmann::json::parse(std::ifstream{test::data_path("evaluation/evo_expected.json")});
  ASSERT_EQ(cases.size(), 36U);
  std::map<std::string, Pair> loaded;
  for (const auto& expected : cases) {
    const std::string name = expected["case"];
    if (!loaded.contains(name)) { loaded[name] = load(name); }
    std::vector<double> errors = errors_of(expected, loaded[name]);
    SCOPED_TRACE(expected.dump());
    ASSERT_EQ(errors.size(), expected["pairs"].get<std::size_t>());
    const auto actual = statistics_of(errors);
    ASSERT_TRUE(actual);
    const auto agree = [&](const char* key, double value) {
      const double wanted = expected[key];
      EXPECT_NEAR(value, wanted, 1e-9 * std::abs(wanted))
          << key << " off by " << (value - wanted) / wanted;
    };
    agree("rmse", actual->rmse);
    agree("mean", actual->mean);
    agree("median", actual->median);
    agree("std", actual->std);
    agree("min", actual->min);
    agree("max", actual->max);
    agree("sse", actual->sse);
  }
}

}  // namespace
}  // namespace picolo
