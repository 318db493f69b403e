// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// CANopen service data, set-up of nodes, overlapping identifiers, candump.

#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "picolo/devices/candump.hpp"
#include "picolo/devices/registry.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/canopen/sdo_client.hpp"
#include "support/fake_can_bus.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

nlohmann::json json_of(const char* name) {
  std::ifstream file{data_path(name)};
  return nlohmann::json::parse(file);
}

TEST(CanopenSdo, GivenPublishedAnswersThenTheyAreReadWhateverTheirLength) {
  PICOLO_NEED_DATA("drivers/can/canopen_python_vectors.json");
  const auto vectors = json_of("drivers/can/canopen_python_vectors.json").at("sdo");
  auto answer = [&vectors](std::size_t i) {
    return parse_can_frame(vectors.at(i).at("rx").get<std::string>());
  };
  auto request = [&vectors](std::size_t i) {
    return parse_can_frame(vectors.at(i).at("tx").get<std::string>());
  };
  canopen::SdoClient client{1};
  client.read(0x1018, 1);
  EXPECT_EQ(client.frame().id, request(0).id);
  EXPECT_EQ(client.frame().data, request(0).data);
  EXPECT_FALSE(client.consume(answer(1)));  // another node's
  EXPECT_TRUE(client.consume(answer(0)));
  EXPECT_EQ(client.state(), canopen::SdoState::done);
  EXPECT_EQ(client.value(), 4U);
  canopen::SdoClient second{2};
  second.read(0x1400, 2);
  EXPECT_TRUE(second.consume(answer(1)));
  EXPECT_EQ(second.value(), 0xFEU);
  second.read(0x1400, 2);
  EXPECT_TRUE(second.consume(answer(2)));
  EXPECT_EQ(second.value(), 0xFEU);
  second.write(0x1017, 0, 4000, 2);
  EXPECT_EQ(second.frame().data, request(3).data);
  EXPECT_TRUE(second.consume(answer(3)));
  EXPECT_EQ(second.state(), canopen::SdoState::done);
  second.read(0x1008, 0);
  EXPECT_TRUE(second.consume(answer(4)));
  EXPECT_EQ(second.state(), canopen::SdoState::unsupported);
  second.read(0x1008, 0);
  second.sent(Timestamp{1s});
  second.service(Timestamp{2s});
  EXPECT_EQ(second.state(), canopen::SdoState::timed_out);
}

TEST(CanopenSetup, GivenTwoDrivesThenTheyAreTaughtAsTheRecordedMasterDoesAndThenStarted) {
  FakeCanBus bus;
  CanopenWheelsConfig config = two_cia402_drives(1, 2);
  config.setup = {.enabled = true, .transmission_type = 1, .heartbeat_ms = 100};
  for (std::size_t i = 0; i < 2; ++i) {
    config.wheels[i].mapping = {{{0x606C, 0, 32}, {0x6064, 0, 32}}};
    config.wheels[i].velocity_index = 0x606C;
  }
  ASSERT_TRUE(config.valid());
  CanopenWheels wheels{bus, config};
  Timestamp now{1s};
  std::vector<CanFrame> to_first;
  bool refuse_once = true;
  for (int i = 0; i < 1000; ++i, now += 5ms) {
    if (i == 0) {
      for (std::uint32_t node = 1; node <= 2; ++node) {
        wheels.consume(can_frame(now, 0x700 + node, {0x00}));
      }
    }
    static_cast<void>(wheels.service(now));
    for (const CanFrame& sent : bus.take_sent()) {
      if (sent.id == 0x601) { to_first.push_back(sent); }
      if (sent.id < 0x601 || sent.id > 0x602) {
        to_first.push_back(sent);
        continue;
      }
      CanFrame answer{.stamp = now, .id = sent.id - 0x80, .length = 8, .data = sent.data};
      answer.data[0] = 0x60;
      if (refuse_once && sent.id == 0x602) {
        answer.data[0] = 0x80;
        store_u32_le(answer.data, 4, 0x08000022);
        refuse_once = false;
      }
      wheels.consume(answer);
    }
  }
  // 0x1017, then the six of the recording, then NMT start to node 1 (and later to node 2).
  ASSERT_GE(to_first.size(), 9U);
  EXPECT_EQ(to_first[0].data, parse_can_frame("601#2B17100064000000").data);
  EXPECT_EQ(to_first[1].data, parse_can_frame("601#2300180181010080").data);
  EXPECT_EQ(to_first[2].data, parse_can_frame("601#2F00180201000000").data);
  EXPECT_EQ(to_first[3].data, parse_can_frame("601#2F001A0000000000").data);
  EXPECT_EQ(to_first[4].data, parse_can_frame("601#23001A0120006C60").data);
  EXPECT_EQ(to_first[5].data, parse_can_frame("601#23001A0220006460").data);
  EXPECT_EQ(to_first[6].data, parse_can_frame("601#2F001A0002000000").data);
  EXPECT_EQ(to_first[7].data, parse_can_frame("601#2300180181010000").data);
  EXPECT_EQ(to_first[8].id, 0U);
  EXPECT_EQ(wheels.counters().setup_failures, 1U);
  EXPECT_EQ(wheels.setup_abort_code(1), 0x08000022U);
  EXPECT_EQ(wheels.node(0).starts_sent, 10U);  // this node never answers with its state
  EXPECT_GE(wheels.node(1).starts_sent, 1U);
}

TEST(CanOverlap, GivenTwoDriversOnOneIdentifierThenItIsNamed) {
  FakeCanBus bus;
  const auto canopen = devices::make_wheels("canopen", bus);
  const auto odrive = devices::make_wheels("odrive", bus, {.left_id = 12, .right_id = 13});
  const auto apart = devices::make_wheels("odrive", bus, {.left_id = 1, .right_id = 3});
  const auto vesc = devices::make_wheels("vesc", bus);
  EXPECT_EQ(
      devices::describe_overlap({{"canopen", canopen->filters()}, {"odrive", odrive->filters()}}),
      "identifier 0x181 is used by canopen and by odrive; give one of them another node");
  EXPECT_EQ(devices::describe_overlap({{"canopen", canopen->filters()},
                                       {"odrive", apart->filters()},
                                       {"vesc", vesc->filters()}}),
            "");
  EXPECT_THROW(static_cast<void>(devices::make_wheels("tank", bus)), std::invalid_argument);
}

TEST(Candump, GivenBothFormatsThenTheFramesAreTheSameAndTheRestIsRefused) {
  const auto compact = devices::parse_candump("(12.345678) can0 1D6#000000000041002B");
  const auto spread =
      devices::parse_candump("  can0  RX - -  1D6   [8]  00 00 00 00 00 41 00 2B   '.....A.+'");
  ASSERT_TRUE(compact && spread);
  EXPECT_EQ(compact->stamp, Timestamp{Duration{12'345'678}});
  EXPECT_EQ(compact->data, spread->data);
  EXPECT_TRUE(devices::parse_candump("(1.0) can0 00000901#0000012C00000000")->extended);
  EXPECT_TRUE(devices::parse_candump("can0 123#R")->remote);
  for (const char* bad :
       {"", "# comment", "(1.0) can0 123##100", "(x) can0 123#00", "can0 1234567890#00",
        "can0 123#0", "can0 20000040#00", "can0 123 [9] 00", "can0 FFF#00"}) {
    EXPECT_FALSE(devices::parse_candump(bad)) << bad;
  }
}

}  // namespace
}  // namespace picolo::test
