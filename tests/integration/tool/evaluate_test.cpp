// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <string>

#include "support/data.hpp"
#include "tool_run.hpp"

namespace picolo {
namespace {

using test::run_tool;
using test::TemporaryFolder;
using ::testing::HasSubstr;

/// A curve in space, moved by `shift`, one pose a second.
std::string tum(int count, double shift, double scale = 1.0) {
  std::string text;
  for (int i = 0; i < count; ++i) {
    const double s = 0.2 * i;
    text +=
        fmt::format("{} {:.9f} {:.9f} {:.9f} 0 0 {:.12f} {:.12f}\n", i, scale * std::cos(s) + shift,
                    scale * std::sin(s), scale * 0.1 * s * s, std::sin(s / 2), std::cos(s / 2));
  }
  return text;
}

TEST(Evaluate, GivenEvosCasesThenTheCommandAgreesToNineDigits) {
  PICOLO_NEED_DATA("evaluation/evo_expected.json");
  const TemporaryFolder folder;
  const auto cases =
      host::Json::parse(std::ifstream{test::data_path("evaluation/evo_expected.json")});
  const std::map<std::string, std::string> words{{"translation_part", "trans"},
                                                 {"rotation_angle_deg", "rot"},
                                                 {"full_transformation", "full"},
                                                 {"frames", "frames"},
                                                 {"meters", "m"},
                                                 {"degrees", "deg"}};
  const auto file = [](const std::string& name) {
    return test::data_path("evaluation/" + name + ".txt.gz").string();
  };
  for (const auto& expected : cases) {
    const bool kitti = expected["case"].get<std::string>().starts_with("KITTI");
    std::vector<std::string> arguments{"evaluate",
                                       expected["metric"],
                                       file(kitti ? "KITTI_00_gt" : "fr2_desk_groundtruth"),
                                       file(kitti ? "KITTI_00_ORB" : "fr2_desk_ORB"),
                                       "--json",
                                       "--align",
                                       expected["align"],
                                       "--relation",
                                       words.at(expected["relation"])};
    if (expected["metric"] == "rpe") {
      const std::string delta = fmt::format("{}", expected["delta"].get<double>());
      for (const std::string& word :
           {std::string{"--delta"}, delta, std::string{"--unit"}, words.at(expected["unit"])}) {
        arguments.push_back(word);
      }
      if (expected["all_pairs"].get<bool>()) { arguments.emplace_back("--all-pairs"); }
    }
    const auto run = run_tool(folder, arguments);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto actual = run.json();
    EXPECT_EQ(actual["pairs"], expected["pairs"]);
    for (const char* key : {"rmse", "mean", "median", "std", "min", "max", "sse"}) {
      const double wanted = expected[key];
      EXPECT_NEAR(actual[key].get<double>(), wanted, 1e-9 * wanted) << key << expected;
    }
  }
}

TEST(Evaluate, GivenAPipeAndAFolderThenPicturesAreDrawn) {
  const TemporaryFolder folder;
  const auto reference = folder.write("ref.txt", tum(100, 0.0));
  const auto estimate = folder.write("est.txt", tum(100, 0.5));
  const auto run =
      run_tool(folder, {"evaluate", "ape", reference, "-", "--out", "pictures"}, estimate);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("rmse    0.5\n"));
  for (const char* name : {"error", "error_map", "position"}) {
    for (const char* end : {".svg", ".png"}) {
      EXPECT_GT(std::filesystem::file_size(folder.path() / "pictures" / (std::string{name} + end)),
                1000U);
    }
  }
}

TEST(Evaluate, GivenAlignmentsThenEachRemovesWhatItMay) {
  const TemporaryFolder folder;
  const auto reference = folder.write("ref.txt", tum(100, 0.0));
  const auto moved = folder.write("moved.txt", tum(100, 0.5));
  const auto scaled = folder.write("scaled.txt", tum(100, 0.5, 2.0));
  const auto rmse = [&](const std::string& estimate, const std::string& align) {
    const auto run =
        run_tool(folder, {"evaluate", "ape", reference, estimate, "--json", "--align", align});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.json()["rmse"].get<double>();
  };
  for (const char* align : {"origin", "se2", "se3", "sim3"}) {
    EXPECT_LT(rmse(moved, align), 1e-7);
  }
  EXPECT_NEAR(rmse(moved, "none"), 0.5, 1e-9);
  EXPECT_GT(rmse(scaled, "se3"), 0.5);
  EXPECT_LT(rmse(scaled, "sim3"), 1e-7);
}

TEST(Evaluate, GivenStampsOfAnotherClockThenOffsetAndInterpolationHelp) {
  const TemporaryFolder folder;
  const auto reference = folder.write("ref.txt", tum(100, 0.0));
  std::string late;
  for (int i = 0; i < 99; ++i) {
    const double s = 0.2 * (i + 0.5);
    late += fmt::format("{} {:.9f} {:.9f} {:.9f} 0 0 0 1\n", 1000.5 + i, std::cos(s), std::sin(s),
                        0.1 * s * s);
  }
  const auto estimate = folder.write("est.txt", late);
  const auto lost = run_tool(folder, {"evaluate", "ape", reference, estimate});
  EXPECT_EQ(lost.exit_code, 3);
  EXPECT_THAT(lost.err, HasSubstr("--offset"));
  const auto found = run_tool(folder, {"evaluate", "ape", reference, estimate, "--offset", "-1000",
                                       "--interpolate", "--json"});
  ASSERT_EQ(found.exit_code, 0) << found.err;
  EXPECT_EQ(found.json()["pairs"], 99);
  EXPECT_LT(found.json()["max"].get<double>(), 0.006);  // the chord of the curve
}

TEST(Evaluate, GivenALongWayThenKittiScoresIt) {
  PICOLO_NEED_DATA("evaluation/KITTI_00_gt.txt.gz");
  const TemporaryFolder folder;
  const auto run = run_tool(
      folder, {"evaluate", "kitti", test::data_path("evaluation/KITTI_00_gt.txt.gz").string(),
               test::data_path("evaluation/KITTI_00_ORB.txt.gz").string(), "--json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_NEAR(run.json()["translation_percent"].get<double>(), 0.70, 0.01);
  EXPECT_THAT(run.json()["by_length"], ::testing::SizeIs(8));
}

TEST(Evaluate, GivenWrongUseThenExitCodesAndMessagesSayWhy) {
  const TemporaryFolder folder;
  const auto ten = folder.write("ten.txt", tum(10, 0.0));
  const auto kitti = folder.write("kitti.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(run_tool(folder, {"evaluate", "ape", ten}).exit_code, 2);
  EXPECT_EQ(run_tool(folder, {"evaluate", "ape", ten, ten, "--align", "x"}).exit_code, 2);
  EXPECT_EQ(run_tool(folder, {"evaluate", "ape", "-", "-"}).exit_code, 2);
  EXPECT_EQ(run_tool(folder, {"evaluate", "rpe", ten, ten, "--delta", "0"}).exit_code, 2);
  EXPECT_EQ(run_tool(folder, {"evaluate", "rpe", ten, ten, "--delta", "50"}).exit_code, 1);
  EXPECT_EQ(run_tool(folder, {"evaluate", "kitti", ten, ten}).exit_code, 1);
  EXPECT_EQ(run_tool(folder, {"evaluate", "ape", kitti, kitti, "--align", "se3"}).exit_code, 1);
  const auto mixed = run_tool(folder, {"evaluate", "ape", ten, kitti});
  EXPECT_EQ(mixed.exit_code, 3);
  EXPECT_THAT(mixed.err, HasSubstr("stamps"));
  const auto missing = run_tool(folder, {"evaluate", "ape", ten, "missing.txt"});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_THAT(missing.err, HasSubstr("missing.txt"));
}

}  // namespace
}  // namespace picolo
