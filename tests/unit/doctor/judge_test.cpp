// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "doctor/findings.hpp"

namespace picolo::tool {
namespace {

using ::testing::HasSubstr;

/// The only fault, or a text that says that there is not one.
Finding fault_of(const Findings& findings) {
  Finding fault{Finding::Level::good, "no fault", ""};
  int count = 0;
  for (const Finding& finding : findings) {
    if (finding.level != Finding::Level::fault) { continue; }
    fault = finding;
    ++count;
  }
  if (count > 1) { fault.what = "several faults"; }
  return fault;
}

CanFacts healthy_bus() {
  CanFacts facts;
  facts.name = "can0";
  facts.bit_rate = 500'000;
  facts.restart_ms = 100;
  facts.frames = 300;
  facts.wanted_nodes = {1, 2};
  facts.heard_nodes = {{1, 0x05}, {2, 0x7F}};
  return facts;
}

TEST(DoctorCan, AHealthyBusHasNoFault) {
  const Findings findings = judge(healthy_bus());
  EXPECT_FALSE(any_fault(findings));
  EXPECT_EQ(findings.size(), 3U) << "the bus and two nodes";
}

TEST(DoctorCan, DownSaysHowToBringItUp) {
  CanFacts facts = healthy_bus();
  facts.is_up = false;
  EXPECT_THAT(fault_of(judge(facts)).cure, HasSubstr("ip link set can0 up type can bitrate"));
  facts.is_virtual = true;
  EXPECT_EQ(fault_of(judge(facts)).cure, "sudo ip link set can0 up");
}

TEST(DoctorCan, AWrongBitRateIsNamedWithTheRateItHas) {
  CanFacts facts = healthy_bus();
  facts.frames = 0;
  facts.heard_nodes.clear();
  facts.protocol_errors = 4000;
  const Finding fault = fault_of(judge(facts));
  EXPECT_THAT(fault.what, HasSubstr("wrong bit rate"));
  EXPECT_THAT(fault.cure, HasSubstr("500000 bit/s"));
}

TEST(DoctorCan, NobodyAcknowledges) {
  CanFacts facts = healthy_bus();
  facts.frames = 0;
  facts.heard_nodes.clear();
  facts.not_acknowledged = 3;
  EXPECT_THAT(fault_of(judge(facts)).what, HasSubstr("acknowledges"));
}

TEST(DoctorCan, BusOffAndThatItStaysSo) {
  CanFacts facts = healthy_bus();
  facts.state = CanState::bus_off;
  facts.restart_ms = 0;
  const Findings findings = judge(facts);
  EXPECT_THAT(fault_of(findings).what, HasSubstr("bus-off"));
  EXPECT_EQ(findings.back().level, Finding::Level::hint);
  EXPECT_THAT(findings.back().cure, HasSubstr("restart-ms 100"));
}

TEST(DoctorCan, AMissingNodeIsNamedAndWhoIsThereInstead) {
  CanFacts facts = healthy_bus();
  facts.heard_nodes = {{1, 0x05}, {7, 0x05}};
  const Finding fault = fault_of(judge(facts));
  EXPECT_THAT(fault.what, HasSubstr("no node 2"));
  EXPECT_THAT(fault.what, HasSubstr("1, 7"));
}

TEST(DoctorCan, NoInterfaceNoCanNoRight) {
  CanFacts facts = healthy_bus();
  facts.exists = false;
  EXPECT_THAT(fault_of(judge(facts)).what, HasSubstr("no such interface"));
  facts.kernel_has_can = false;
  EXPECT_THAT(fault_of(judge(facts)).what, HasSubstr("no CAN"));
  facts = healthy_bus();
  facts.is_can = false;
  EXPECT_THAT(fault_of(judge(facts)).what, HasSubstr("not of CAN"));
  facts = healthy_bus();
  facts.may_open = false;
  EXPECT_THAT(fault_of(judge(facts)).cure, HasSubstr("CAP_NET_RAW"));
}

SerialFacts healthy_line() {
  SerialFacts facts;
  facts.path = "/dev/ttyUSB0";
  facts.device = "lidar";
  facts.trial = {.baud = 230'400, .bytes = 8000, .packets = 170};
  return facts;
}

TEST(DoctorSerial, AHealthyLineHasNoFault) {
  EXPECT_FALSE(any_fault(judge(healthy_line())));
}

TEST(DoctorSerial, PermissionsAndBusyLines) {
  SerialFacts facts = healthy_line();
  facts.may_open = false;
  EXPECT_THAT(fault_of(judge(facts)).cure, HasSubstr("dialout"));
  facts = healthy_line();
  facts.is_busy = true;
  facts.other_readers = " (gpsd 17)";
  EXPECT_THAT(fault_of(judge(facts)).what, HasSubstr("gpsd 17"));
}

TEST(DoctorSerial, AWrongRateIsCuredByTheOneThatWorks) {
  SerialFacts facts = healthy_line();
  facts.trial.packets = 0;
  facts.others = {{.baud = 9600, .bytes = 90, .packets = 0},
                  {.baud = 115'200, .bytes = 4000, .packets = 80}};
  const Finding fault = fault_of(judge(facts));
  EXPECT_THAT(fault.what, HasSubstr("wrong baud rate"));
  EXPECT_EQ(fault.cure, "set baud = 115200 in [lidar] of the configuration");
}

TEST(DoctorSerial, NoBytesBytesOfSomethingElseAndDamagedOnes) {
  SerialFacts facts = healthy_line();
  facts.trial = {.baud = 230'400};
  EXPECT_THAT(fault_of(judge(facts)).what, HasSubstr("no bytes"));
  facts.trial.bytes = 500;
  EXPECT_THAT(fault_of(judge(facts)).what, HasSubstr("no packets of the lidar"));
  facts.trial.packets = 100;
  facts.trial.bad_checksums = 60;
  EXPECT_THAT(fault_of(judge(facts)).what, HasSubstr("checksum storm"));
}

TEST(DoctorSerial, AnAdapterThatHoldsBytesBackIsAHint) {
  SerialFacts facts = healthy_line();
  facts.latency_ms = 16;
  const Findings findings = judge(facts);
  EXPECT_FALSE(any_fault(findings));
  EXPECT_THAT(findings.back().cure, HasSubstr("devices/ttyUSB0/latency_timer"));
}

}  // namespace
}  // namespace picolo::tool
