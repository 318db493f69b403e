// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/canopen/messages.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

#include "picolo/drivers/canopen/cob_id.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

using canopen::decode_emergency;
using canopen::decode_heartbeat;
using canopen::NmtCommand;
using canopen::NmtState;

TEST(CanopenMessages, GivenCommandsThenFramesAreThoseOfTheRecordedMaster) {
  const CanFrame start = canopen::nmt_frame(NmtCommand::start, 2);
  EXPECT_EQ(start.id, 0U);
  EXPECT_EQ(start.length, 2);
  EXPECT_EQ(start.data[0], 0x01);
  EXPECT_EQ(start.data[1], 0x02);
  EXPECT_EQ(canopen::nmt_frame(NmtCommand::reset_communication, 0).data[0], 0x82);
  EXPECT_EQ(canopen::sync_frame().id, 0x80U);
  EXPECT_EQ(canopen::sync_frame().length, 0);
  EXPECT_EQ(canopen::sync_frame(240).length, 1);
  EXPECT_EQ(canopen::sync_frame(240).data[0], 240);
}

TEST(CanopenMessages, GivenHeartbeatsThenOnlyTheFourStatesAreAcceptedAndTheToggleBitIsIgnored) {
  int accepted = 0;
  for (unsigned byte = 0; byte < 256; ++byte) {
    const std::array<std::uint8_t, 1> data{static_cast<std::uint8_t>(byte)};
    const auto state = decode_heartbeat(data);
    if (!state) {
      EXPECT_EQ(state.status(), Status::corrupt);
      continue;
    }
    ++accepted;
    EXPECT_EQ(static_cast<unsigned>(*state), byte & 0x7FU);
  }
  EXPECT_EQ(accepted, 8);
  EXPECT_EQ(decode_heartbeat({}).status(), Status::corrupt);
}

TEST(CanopenMessages, GivenRecordedEmergenciesThenCodeRegisterAndVendorBytesAreAsPublished) {
  PICOLO_NEED_DATA("drivers/can/canopen_python_vectors.json");
  std::ifstream file{data_path("drivers/can/canopen_python_vectors.json")};
  const auto vectors = nlohmann::json::parse(file);
  ASSERT_FALSE(vectors.at("emcy").empty());
  for (const auto& vector : vectors.at("emcy")) {
    const CanFrame frame = parse_can_frame(vector.at("frame"));
    EXPECT_EQ(frame.id, canopen::emergency_id(1));
    const auto emergency = decode_emergency(ByteView{frame.data}.first(frame.length));
    ASSERT_TRUE(emergency);
    EXPECT_EQ(emergency->code, vector.at("code").get<int>());
    EXPECT_EQ(emergency->error_register, vector.at("reg").get<int>());
    EXPECT_EQ(emergency->vendor, (vector.at("data").get<std::array<std::uint8_t, 5>>()));
  }
}

TEST(CanopenMessages, GivenAShortEmergencyThenThreeBytesAreEnoughAndTwoAreNot) {
  const Bytes data = from_hex("1081 11");
  const auto emergency = decode_emergency(data);
  ASSERT_TRUE(emergency);
  EXPECT_EQ(emergency->code, 0x8110);
  EXPECT_EQ(emergency->vendor, (std::array<std::uint8_t, 5>{}));
  EXPECT_EQ(decode_emergency(ByteView{data}.first(2)).status(), Status::corrupt);
}

}  // namespace
}  // namespace picolo::test
