// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/canopen/node_monitor.hpp"

#include <gtest/gtest.h>

namespace picolo::test {
namespace {

using canopen::NmtState;
using canopen::NodeMonitor;
using canopen::NodeMonitorConfig;
using canopen::NodeState;

static_assert(NodeMonitorConfig{}.valid());
static_assert(!NodeMonitorConfig{.start_retry = 0ms}.valid());
static_assert(!NodeMonitorConfig{.max_starts = 0}.valid());

/// Lets the monitor run for a while at 5 ms and answers how many starts it asked for.
int run(NodeMonitor& node, Timestamp from, Duration duration) {
  int starts = 0;
  for (Timestamp now = from; now < from + duration; now += 5ms) {
    node.service(now);
    if (!node.start_due(now)) { continue; }
    node.start_sent(now);
    ++starts;
  }
  return starts;
}

TEST(NodeMonitor, GivenANodeNeverHeardThenItIsSilentAndNotLost) {
  NodeMonitor node{5, {}};
  EXPECT_EQ(run(node, Timestamp{1s}, 10s), 0);
  EXPECT_EQ(node.health().node, 5);
  EXPECT_EQ(node.health().state, NodeState::silent);
  EXPECT_EQ(node.health().losses, 0U);
}

TEST(NodeMonitor, GivenABootUpThenItIsStartedAtOnceAndNoMoreOnceOperational) {
  NodeMonitor node{5, {}};
  node.heartbeat(Timestamp{1s}, NmtState::boot_up);
  EXPECT_EQ(node.health().state, NodeState::booted);
  EXPECT_EQ(node.health().boots, 1U);
  EXPECT_TRUE(node.start_due(Timestamp{1s}));
  node.start_sent(Timestamp{1s});
  EXPECT_FALSE(node.start_due(Timestamp{1s} + 199ms));
  node.heartbeat(Timestamp{1s} + 50ms, NmtState::operational);
  EXPECT_EQ(run(node, Timestamp{1s} + 50ms, 400ms), 0);
  EXPECT_EQ(node.health().state, NodeState::operational);
}

TEST(NodeMonitor, GivenANodeThatStaysPreOperationalThenStartsAreBoundedUntilItBootsAgain) {
  NodeMonitor node{
      5, NodeMonitorConfig{.heartbeat_timeout = 0ms, .start_retry = 100ms, .max_starts = 3}};
  int starts = 0;
  for (int i = 0; i < 20; ++i) {
    node.heartbeat(Timestamp{1s} + i * 100ms, NmtState::pre_operational);
    starts += run(node, Timestamp{1s} + i * 100ms, 100ms);
  }
  EXPECT_EQ(starts, 3);
  EXPECT_TRUE(node.health().gave_up_starting);
  node.heartbeat(Timestamp{10s}, NmtState::boot_up);
  EXPECT_FALSE(node.health().gave_up_starting);
  EXPECT_EQ(run(node, Timestamp{10s}, 5s), 3);
  node.request_start();
  EXPECT_EQ(run(node, Timestamp{20s}, 5s), 3);
  EXPECT_EQ(node.health().starts_sent, 9U);
}

TEST(NodeMonitor, GivenAutoStartOffThenOnlyTheCallerStartsIt) {
  NodeMonitor node{5, NodeMonitorConfig{.heartbeat_timeout = 0ms, .auto_start = false}};
  node.heartbeat(Timestamp{1s}, NmtState::boot_up);
  node.heartbeat(Timestamp{2s}, NmtState::pre_operational);
  EXPECT_EQ(run(node, Timestamp{2s}, 1s), 0);
  node.request_start();
  EXPECT_EQ(run(node, Timestamp{3s}, 100ms), 1);
  node.heartbeat(Timestamp{4s}, NmtState::operational);
  EXPECT_EQ(run(node, Timestamp{4s}, 1s), 0);
}

TEST(NodeMonitor, GivenAStoppedNodeThenItIsLeftAlone) {
  NodeMonitor node{5, {}};
  node.heartbeat(Timestamp{1s}, NmtState::stopped);
  EXPECT_EQ(node.health().state, NodeState::stopped);
  EXPECT_EQ(run(node, Timestamp{1s}, 400ms), 0);
}

TEST(NodeMonitor, GivenSilenceThenLostOnceAndAHeartbeatBringsItBack) {
  NodeMonitor node{5, {}};
  node.heartbeat(Timestamp{1s}, NmtState::operational);
  node.service(Timestamp{1s} + 500ms);
  EXPECT_EQ(node.health().state, NodeState::operational);
  node.service(Timestamp{1s} + 501ms);
  EXPECT_EQ(node.health().state, NodeState::lost);
  node.service(Timestamp{9s});
  EXPECT_EQ(node.health().losses, 1U);
  node.heartbeat(Timestamp{10s}, NmtState::operational);
  EXPECT_EQ(node.health().state, NodeState::operational);
  EXPECT_EQ(node.health().recoveries, 1U);
  EXPECT_EQ(node.health().last_heard, Timestamp{10s});
}

TEST(NodeMonitor, GivenHeartbeatsThatStopWhileDataGoesOnThenTheNodeIsLostUntilTheNextHeartbeat) {
  NodeMonitor node{5, {}};
  node.heartbeat(Timestamp{1s}, NmtState::operational);
  for (int i = 1; i <= 100; ++i) {
    node.process_data(Timestamp{1s} + i * 10ms);
    node.service(Timestamp{1s} + i * 10ms);
  }
  EXPECT_EQ(node.health().state, NodeState::lost);
  EXPECT_EQ(node.health().losses, 1U);
  EXPECT_EQ(node.health().last_heard, Timestamp{2s});
}

TEST(NodeMonitor, GivenANodeWithoutHeartbeatThenItsDataKeepItAliveAndBringItBack) {
  NodeMonitor node{5, {}};
  node.process_data(Timestamp{1s});
  EXPECT_EQ(node.health().state, NodeState::operational);
  node.service(Timestamp{2s});
  EXPECT_EQ(node.health().state, NodeState::lost);
  node.process_data(Timestamp{3s});
  EXPECT_EQ(node.health().state, NodeState::operational);
  EXPECT_EQ(node.health().recoveries, 1U);
}

TEST(NodeMonitor, GivenAStartedNodeWithoutHeartbeatThenItsFirstDataEndTheAttempts) {
  NodeMonitor node{5, {}};
  node.request_start();
  EXPECT_EQ(run(node, Timestamp{1s}, 300ms), 2);
  node.process_data(Timestamp{1s} + 300ms);
  EXPECT_EQ(run(node, Timestamp{1s} + 300ms, 400ms), 0);
}

TEST(NodeMonitor, GivenNoTimeoutThenANodeIsNeverLost) {
  NodeMonitor node{5, NodeMonitorConfig{.heartbeat_timeout = 0ms}};
  node.heartbeat(Timestamp{1s}, NmtState::operational);
  node.service(Timestamp{1'000'000s});
  EXPECT_EQ(node.health().state, NodeState::operational);
}

TEST(NodeMonitor, GivenEmergenciesThenErrorsAreCountedAndAResetClearsTheCurrentOne) {
  NodeMonitor node{5, {}};
  node.emergency(Timestamp{1s}, {.code = 0x8110, .error_register = 0x11});
  node.emergency(Timestamp{2s}, {.code = 0x2310, .error_register = 0x02});
  EXPECT_EQ(node.health().emergency_code, 0x2310);
  node.emergency(Timestamp{3s}, {.code = 0});
  EXPECT_EQ(node.health().emergency_code, 0);
  EXPECT_EQ(node.health().last_emergency_code, 0x2310);
  EXPECT_EQ(node.health().emergencies, 2U);
  EXPECT_EQ(node.health().last_heard, Timestamp{3s});
  EXPECT_EQ(node.health().state, NodeState::silent) << "an emergency says nothing about the state";
}

}  // namespace
}  // namespace picolo::test
