// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// picolo decode: what devices said, as their recordings say it was.

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <sstream>
#include <string>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"
#include "support/bytes.hpp"
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

/// A wall seen by capsules of 84 bytes that no descriptor introduces.
Bytes wall(bool dense) {
  Bytes stream;
  for (std::uint32_t i = 0; i < 12; ++i) {
    Bytes capsule(84);
    store_u16_le(capsule, 2, static_cast<std::uint16_t>(i * 30 * 64 % (360 * 64)));
    for (std::size_t k = 0; k < (dense ? 40 : 32); ++k) {
      const std::size_t mm = 1500 + 40 * i + k;
      const std::size_t at = dense ? 4 + 2 * k : 4 + 5 * (k / 2) + 2 * (k % 2);
      store_u16_le(capsule, at, static_cast<std::uint16_t>(dense ? mm : 4 * mm));
    }
    const std::uint8_t sum = xor8(ByteView{capsule}.subspan(2));
    capsule[0] = static_cast<std::uint8_t>(0xA0U | (sum & 0xFU));
    capsule[1] = static_cast<std::uint8_t>(0x50U | (sum >> 4U));
    stream = join({stream, capsule});
  }
  return stream;
}

TEST(ToolDecode, GivenCapsulesWithoutADescriptorThenTheirModeIsFoundFromWhatTheySay) {
  const TemporaryFolder folder;
  for (const bool dense : {true, false}) {
    const Bytes stream = wall(dense);
    folder.write("stream.bin", {stream.begin(), stream.end()});
    const ToolRun run = run_tool(folder, {"decode", "rplidar", "stream.bin"});
    const auto rows = csv(run.out);
    ASSERT_EQ(rows.size(), 1U + 11U * (dense ? 40U : 32U)) << dense;
    EXPECT_EQ(rows[2][1], "6004") << dense;
  }
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
  EXPECT_EQ(run_tool(folder, {"decode", "ld06", "."}).exit_code, 3);
  EXPECT_EQ(run_tool(folder, {"decode", "dbc:.", "noise.bin"}).exit_code, 3);
  EXPECT_NE(run_tool(folder, {"demo", "--config", "."}).err.find("is a folder"), std::string::npos);
  folder.write("empty.bin", "");
  EXPECT_NE(run_tool(folder, {"decode", "vesc", "empty.bin"}).err.find("empty.bin: is empty"),
            std::string::npos);
  folder.write("bus.log", "(1.5) can0 00001B01#0000006400F00000\n");
  const ToolRun bus = run_tool(folder, {"decode", "scip", "bus.log"});
  EXPECT_NE(bus.err.find("it looks like a candump log"), std::string::npos) << bus.err;
  const Bytes stream = wall(true);
  folder.write("stream.bin", {stream.begin(), stream.end()});
  const ToolRun other = run_tool(folder, {"decode", "witmotion", "stream.bin"});
  EXPECT_NE(other.err.find("it looks like rplidar"), std::string::npos) << other.err;
}

}  // namespace
}  // namespace picolo::test
