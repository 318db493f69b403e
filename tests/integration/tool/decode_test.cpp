// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// picolo decode: what devices said, as their recordings say it was.

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <sstream>
#include <string>

#include "support/data.hpp"
#include "support/vectors.hpp"
#include "tool_run.hpp"

namespace picolo::test {
namespace {

std::vector<std::vector<std::string>> csv(const std::string& text) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines{text};
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields;
    std::istringstream words{line};
    for (std::string word; std::getline(words, word, ',');) { fields.push_back(word); }
    rows.push_back(fields);
  }
  return rows;
}

TEST(ToolDecode, GivenTheRecordedVectorsThenEachIsShownByItsProtocol) {
  PICOLO_NEED_DATA(kVectorFile);
  const TemporaryFolder folder;
  const std::map<std::string, std::pair<std::string, std::size_t>> protocols{
      {"LD06/LD19", {"ld06", 12}},
      {"WitMotion standard", {"witmotion", 0}},
      {"BNO08x UART-RVC", {"bno08x-rvc", 1}},
      {"Xsens MTData2", {"xsens", 1}},
      {"VectorNav ASCII", {"vectornav", 1}},
      {"YDLIDAR AA55 3-byte (intensity)", {"ydlidar", 39}}};
  for (const auto& [protocol, expected] : protocols) {
    for (const ByteVector& vector : byte_vectors(protocol)) {
      SCOPED_TRACE(vector.id);
      folder.write("bytes.bin", {vector.bytes.begin(), vector.bytes.end()});
      const ToolRun run = run_tool(folder, {"decode", expected.first, "bytes.bin"});
      EXPECT_EQ(run.exit_code, 0) << run.err;
      const std::size_t samples = expected.second != 0
                                      ? expected.second
                                      : vector.expected.at("valid_frames").get<std::size_t>();
      EXPECT_EQ(csv(run.out).size(), samples + 1);
    }
  }
}

TEST(ToolDecode, GivenHokuyoAndRplidarStreamsThenColumnsAreThoseOfTheReferences) {
  PICOLO_NEED_DATA("drivers/hokuyo/urg_04lx.raw");
  const TemporaryFolder folder;
  const ToolRun scip =
      run_tool(folder, {"decode", "scip", data_path("drivers/hokuyo/urg_04lx.raw").string()});
  ASSERT_EQ(csv(scip.out).size(), 683U);
  EXPECT_EQ(csv(scip.out)[1], (std::vector<std::string>{"6968830", "44", "-119.5313", "392"}));
  const std::string stream =
      data_path("drivers/rplidar/FG_Measurements_sample_data_pyserial_3.bin").string();
  const ToolRun rplidar = run_tool(folder, {"decode", "rplidar", stream});
  EXPECT_EQ(rplidar.out.substr(0, 35), "angle_z_q14,dist_mm_q2,quality,flag");
  EXPECT_EQ(csv(rplidar.out)[1], (std::vector<std::string>{"29587", "0", "60", "0"}));
}

TEST(ToolDecode, GivenCanLogsThenValuesComeWithTheirNamesAndMappingsAreLearnt) {
  PICOLO_NEED_DATA("drivers/can/canopen_navican_cia402.candump");
  const TemporaryFolder folder;
  const ToolRun canopen = run_tool(
      folder, {"decode", "canopen",
               data_path("drivers/can/canopen_navican_cia402.candump").string(), "--json"});
  EXPECT_EQ(canopen.exit_code, 0);
  EXPECT_NE(canopen.out.find(R"("message":"tpdo2","signal":"6064:00","value":-2)"),
            std::string::npos);
  folder.write("vesc.log", "(1.5) can0 00001B01#0000006400F00000\n");
  const ToolRun vesc = run_tool(folder, {"decode", "vesc", "vesc.log"});
  EXPECT_EQ(csv(vesc.out)[1],
            (std::vector<std::string>{"1.5", "00001B01", "1", "status_5", "tachometer", "100"}));
  const ToolRun dbc =
      run_tool(folder, {"decode", "dbc:" + data_path("drivers/can/nissan_leaf_2018.dbc").string(),
                        data_path("drivers/can/test_nissan_leaf_traffic.log").string()});
  EXPECT_EQ(dbc.exit_code, 0);
  EXPECT_GT(csv(dbc.out).size(), 10'000U);
}

TEST(ToolDecode, GivenWhatItCannotDecodeThenItSaysWhyAndHow) {
  const TemporaryFolder folder;
  folder.write("noise.bin", "not a lidar");
  const ToolRun noise = run_tool(folder, {"decode", "ld06", "noise.bin"});
  EXPECT_EQ(noise.exit_code, 3);
  EXPECT_NE(noise.err.find("noise.bin: holds nothing that ld06 would say"), std::string::npos);
  EXPECT_EQ(run_tool(folder, {"decode", "ld99", "noise.bin"}).exit_code, 2);
  EXPECT_EQ(run_tool(folder, {"decode", "dbc:none.dbc", "noise.bin"}).exit_code, 3);
  EXPECT_EQ(run_tool(folder, {"decode", "ld06", "missing.bin"}).exit_code, 3);
}

}  // namespace
}  // namespace picolo::test
