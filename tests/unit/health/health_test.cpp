// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/localisation/health.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>

namespace picolo {
namespace {

using State = HealthState;
using Reason = HealthReason;

constexpr HealthConfig kConfig{};
static_assert(kConfig.valid());

/// All is well: fresh sensors, a long row of accepted matches.
HealthInputs good() {
  return {.lidar_age = 100ms,
          .wheels_age = 10ms,
          .gyro_age = 10ms,
          .match_age = 150ms,
          .accepted_streak = 100,
          .position_variance_m2 = 0.0004F};
}

/// A monitor that a test walks through time in steps of 25 ms.
struct Walk {
  HealthMonitor monitor{kConfig};
  Timestamp now{Timestamp{10s}};
  HealthTransition last{};

  void once(HealthInputs inputs) {
    now += 25ms;
    inputs.now = now;
    last = monitor.update(inputs);
  }
  void hold(const HealthInputs& inputs, Duration length) {
    for (Duration passed{0}; passed < length; passed += 25ms) { once(inputs); }
  }
  void bring_to(State state) {
    if (state == State::initialising) { return; }
    once(good());
    HealthInputs inputs = good();
    if (state == State::degraded) {
      inputs.wheels_age = kConfig.max_wheels_age + 1us;
      once(inputs);
    }
    if (state == State::lost) {
      inputs.accepted_streak = 0;
      inputs.rejected_streak = kConfig.lost_rejections;
      once(inputs);
    }
    if (state == State::fault) {
      inputs.cycle_fault = true;
      once(inputs);
    }
    ASSERT_EQ(monitor.state(), state);
  }
};

struct Transition {
  std::string name;
  State from;
  std::function<void(HealthInputs&)> change;
  State to;
  Reason reason;
};

// NOLINTNEXTLINE(readability-identifier-naming): Google Test looks for this name
void PrintTo(const Transition& transition, std::ostream* out) {
  *out << transition.name;
}

class AtOnce : public ::testing::TestWithParam<Transition> {};

TEST_P(AtOnce, GivenAStateWhenOneUpdateBringsACauseThenStateAndReason) {
  Walk walk;
  walk.bring_to(GetParam().from);
  HealthInputs inputs = good();
  GetParam().change(inputs);
  walk.once(inputs);
  EXPECT_EQ(to_string(walk.monitor.state()), std::string{to_string(GetParam().to)});
  EXPECT_EQ(to_string(walk.monitor.reason()), std::string{to_string(GetParam().reason)});
  EXPECT_EQ(walk.last.from, GetParam().from);
  EXPECT_EQ(walk.last.to, GetParam().to);
  EXPECT_EQ(walk.last.state_changed, GetParam().from != GetParam().to);
}

const auto nothing = [](HealthInputs&) {};
const auto no_match_yet = [](HealthInputs& in) { in.accepted_streak = 0; };
const auto almost_initialised = [](HealthInputs& in) {
  in.accepted_streak = kConfig.initial_matches - 1;
};
const auto lidar_silent = [](HealthInputs& in) { in.lidar_age = kConfig.max_lidar_age + 1us; };
const auto lidar_at_limit = [](HealthInputs& in) { in.lidar_age = kConfig.max_lidar_age; };
const auto wheels_silent = [](HealthInputs& in) { in.wheels_age = kConfig.max_wheels_age + 1us; };
const auto gyro_silent = [](HealthInputs& in) { in.gyro_age = kConfig.max_gyro_age + 1us; };
const auto blind = [](HealthInputs& in) {
  in.lidar_age = kConfig.max_blind + 1us;
  in.wheels_age = kConfig.max_blind + 2us;
  in.match_age = kConfig.max_blind + 3us;
};
const auto no_wheels_no_match = [](HealthInputs& in) {
  in.wheels_age = kConfig.max_blind + 1us;
  in.match_age = kConfig.max_blind + 1us;
};
const auto no_wheels_but_matches = [](HealthInputs& in) { in.wheels_age = 1h; };
const auto both_silent = [](HealthInputs& in) {
  in.lidar_age = kConfig.max_lidar_age + 1us;
  in.wheels_age = kConfig.max_wheels_age + 1us;
};
const auto rejected_once = [](HealthInputs& in) {
  in.accepted_streak = 0;
  in.rejected_streak = 1;
};
const auto rejected_some = [](HealthInputs& in) {
  in.accepted_streak = 0;
  in.rejected_streak = kConfig.degraded_rejections;
  in.rejection = Reason::too_few_points;
};
const auto rejected_many = [](HealthInputs& in) {
  in.accepted_streak = 0;
  in.rejected_streak = kConfig.lost_rejections;
  in.rejection = Reason::out_of_map;
};
const auto corridor = [](HealthInputs& in) { in.direction_unobservable = true; };
const auto vague = [](HealthInputs& in) { in.position_variance_m2 = 0.26F; };
const auto vague_and_silent = [](HealthInputs& in) {
  in.position_variance_m2 = 0.26F;
  in.lidar_age = 1s;
};
const auto not_a_number = [](HealthInputs& in) {
  in.position_variance_m2 = std::numeric_limits<float>::quiet_NaN();
};
const auto contradiction = [](HealthInputs& in) { in.sensors_disagree = true; };
const auto old_match = [](HealthInputs& in) { in.match_age = kConfig.max_match_age + 1us; };
const auto long_search = [](HealthInputs& in) {
  in.match_age = kConfig.max_match_age + 1us;
  in.relocalising = true;
};
const auto overran = [](HealthInputs& in) { in.overruns = 1; };
const auto cycle_fault = [](HealthInputs& in) { in.cycle_fault = true; };
const auto bad_configuration = [](HealthInputs& in) { in.configuration_refused = true; };
const auto relocalising = [](HealthInputs& in) {
  in.accepted_streak = 0;
  in.relocalising = true;
};
const auto some_accepted = [](HealthInputs& in) {
  in.accepted_streak = kConfig.relocalised_matches - 1;
};

INSTANTIATE_TEST_SUITE_P(
    Health, AtOnce,
    ::testing::Values(
        Transition{"init_no_match", State::initialising, no_match_yet, State::initialising,
                   Reason::starting},
        Transition{"init_few_matches", State::initialising, almost_initialised, State::initialising,
                   Reason::starting},
        Transition{"init_matches", State::initialising, nothing, State::tracking, Reason::none},
        Transition{"init_without_gyro", State::initialising, gyro_silent, State::degraded,
                   Reason::gyro_silent},
        Transition{"init_in_corridor", State::initialising, corridor, State::degraded,
                   Reason::direction_unobservable},
        Transition{"init_blind", State::initialising, blind, State::initialising,
                   Reason::lidar_silent},
        Transition{"init_config", State::initialising, bad_configuration, State::fault,
                   Reason::configuration},
        Transition{"tracking_stays", State::tracking, nothing, State::tracking, Reason::none},
        Transition{"tracking_lidar_at_limit", State::tracking, lidar_at_limit, State::tracking,
                   Reason::none},
        Transition{"tracking_one_rejection", State::tracking, rejected_once, State::tracking,
                   Reason::none},
        Transition{"tracking_lidar", State::tracking, lidar_silent, State::degraded,
                   Reason::lidar_silent},
        Transition{"tracking_wheels", State::tracking, wheels_silent, State::degraded,
                   Reason::wheels_silent},
        Transition{"tracking_gyro", State::tracking, gyro_silent, State::degraded,
                   Reason::gyro_silent},
        Transition{"tracking_rejections", State::tracking, rejected_some, State::degraded,
                   Reason::too_few_points},
        Transition{"tracking_corridor", State::tracking, corridor, State::degraded,
                   Reason::direction_unobservable},
        Transition{"tracking_contradiction", State::tracking, contradiction, State::degraded,
                   Reason::sensors_disagree},
        Transition{"tracking_old_match", State::tracking, old_match, State::degraded,
                   Reason::match_rejected},
        Transition{"tracking_long_search", State::tracking, long_search, State::degraded,
                   Reason::relocalising},
        Transition{"tracking_overrun", State::tracking, overran, State::degraded, Reason::overrun},
        Transition{"tracking_both_silent", State::tracking, both_silent, State::degraded,
                   Reason::lidar_silent},
        Transition{"tracking_blind", State::tracking, blind, State::lost, Reason::lidar_silent},
        Transition{"tracking_no_wheels_no_match", State::tracking, no_wheels_no_match, State::lost,
                   Reason::wheels_silent},
        Transition{"tracking_no_wheels_but_matches", State::tracking, no_wheels_but_matches,
                   State::degraded, Reason::wheels_silent},
        Transition{"tracking_many_rejections", State::tracking, rejected_many, State::lost,
                   Reason::out_of_map},
        Transition{"tracking_vague", State::tracking, vague, State::lost, Reason::match_rejected},
        Transition{"tracking_vague_silent", State::tracking, vague_and_silent, State::lost,
                   Reason::lidar_silent},
        Transition{"tracking_nan", State::tracking, not_a_number, State::lost,
                   Reason::match_rejected},
        Transition{"tracking_fault", State::tracking, cycle_fault, State::fault, Reason::overrun},
        Transition{"degraded_not_at_once", State::degraded, nothing, State::degraded,
                   Reason::wheels_silent},
        Transition{"degraded_other_cause", State::degraded, gyro_silent, State::degraded,
                   Reason::gyro_silent},
        Transition{"degraded_blind", State::degraded, blind, State::lost, Reason::lidar_silent},
        Transition{"degraded_fault", State::degraded, cycle_fault, State::fault, Reason::overrun},
        Transition{"lost_searching", State::lost, relocalising, State::relocalising,
                   Reason::relocalising},
        Transition{"lost_few_matches", State::lost, some_accepted, State::lost,
                   Reason::match_rejected},
        Transition{"lost_found", State::lost, nothing, State::degraded, Reason::relocalising},
        Transition{"lost_found_without_gyro", State::lost, gyro_silent, State::degraded,
                   Reason::gyro_silent},
        Transition{"lost_still", State::lost, blind, State::lost, Reason::lidar_silent},
        Transition{"lost_fault", State::lost, bad_configuration, State::fault,
                   Reason::configuration},
        Transition{"fault_for_good", State::fault, nothing, State::fault, Reason::overrun}),
    [](const auto& param) { return param.param.name; });

TEST(Health, GivenDegradedWhenTheCauseIsGoneLongEnoughThenTracking) {
  Walk walk;
  walk.bring_to(State::degraded);
  walk.once(good());
  walk.hold(good(), kConfig.recover_after - 25ms);
  EXPECT_EQ(walk.monitor.state(), State::degraded);
  walk.once(good());
  EXPECT_EQ(walk.monitor.state(), State::tracking);
  EXPECT_TRUE(walk.last.state_changed);
  EXPECT_TRUE(walk.last.reason_changed);
}

TEST(Health, GivenACauseThatFlickersThenDegradedStaysThroughout) {
  Walk walk;
  walk.bring_to(State::degraded);
  HealthInputs inputs = good();
  for (int i = 0; i < 100; ++i) {
    inputs.direction_unobservable = i % 10 == 0;  // every 250 ms
    walk.once(inputs);
    ASSERT_EQ(walk.monitor.state(), State::degraded);
  }
}

TEST(Health, GivenSensorsBackButTooFewMatchesThenStillDegraded) {
  Walk walk;
  walk.bring_to(State::degraded);
  HealthInputs inputs = good();
  inputs.accepted_streak = kConfig.recover_matches - 1;
  walk.hold(inputs, 5s);
  EXPECT_EQ(walk.monitor.state(), State::degraded);
  ++inputs.accepted_streak;
  walk.once(inputs);
  EXPECT_EQ(walk.monitor.state(), State::tracking);
}

TEST(Health, GivenOneOverrunThenDegradedForTheHoldTimeAndNoLonger) {
  Walk walk;
  walk.bring_to(State::tracking);
  HealthInputs inputs = good();
  inputs.overruns = 7;  // stays at 7: no further ones
  walk.once(inputs);
  EXPECT_EQ(walk.monitor.reason(), Reason::overrun);
  walk.hold(inputs, kConfig.overrun_hold);
  EXPECT_EQ(walk.monitor.state(), State::degraded);
  walk.hold(inputs, kConfig.recover_after + 25ms);
  EXPECT_EQ(walk.monitor.state(), State::tracking);
}

TEST(Health, GivenToleratedOverrunsThenOnlyMoreWithinTheHoldTimeCount) {
  HealthConfig config = kConfig;
  config.tolerated_overruns = 3;
  Walk walk{.monitor = HealthMonitor{config}};
  walk.bring_to(State::tracking);
  HealthInputs inputs = good();
  for (int seconds = 0; seconds < 5; ++seconds) {
    inputs.overruns += 3;
    walk.once(inputs);
    EXPECT_EQ(walk.monitor.state(), State::tracking) << "three now and then";
    walk.hold(inputs, config.overrun_hold + 25ms);
  }
  inputs.overruns += 3;
  walk.once(inputs);
  inputs.overruns += 1;
  walk.once(inputs);
  EXPECT_EQ(walk.monitor.reason(), Reason::overrun) << "a fourth one at once";
}

TEST(Health, GivenLostThenTheWayBackLeadsThroughDegraded) {
  Walk walk;
  walk.bring_to(State::lost);
  walk.once(good());
  EXPECT_EQ(walk.monitor.state(), State::degraded);
  walk.hold(good(), kConfig.recover_after);
  EXPECT_EQ(walk.monitor.state(), State::tracking);
}

TEST(Health, GivenNoGyroIsExpectedThenItsSilenceIsNoCause) {
  HealthConfig config = kConfig;
  config.expects_gyro = false;
  HealthMonitor monitor{config};
  HealthInputs inputs = good();
  inputs.gyro_age = 1h;
  EXPECT_EQ(monitor.update(inputs).to, State::tracking);
}

TEST(Health, GivenFaultWhenResetThenInitialisingAgain) {
  Walk walk;
  walk.bring_to(State::fault);
  walk.monitor.reset();
  EXPECT_EQ(walk.monitor.state(), State::initialising);
  EXPECT_EQ(walk.monitor.reason(), Reason::starting);
  walk.once(good());
  EXPECT_EQ(walk.monitor.state(), State::tracking);
}

TEST(Health, EveryStateAndReasonHasItsOwnName) {
  std::set<std::string> names;
  for (int i = 0; i <= 4; ++i) { names.insert(to_string(static_cast<State>(i))); }
  EXPECT_EQ(names.size(), 5U);
  for (int i = 0; i <= 12; ++i) { names.insert(to_string(static_cast<Reason>(i))); }
  EXPECT_EQ(names.size(), 18U);
  EXPECT_EQ(names.count("unknown"), 0U);
  EXPECT_STREQ(to_string(static_cast<State>(99)), "unknown");
  EXPECT_STREQ(to_string(static_cast<Reason>(99)), "unknown");
}

TEST(HealthConfig, GivenLimitsThatContradictEachOtherThenRefused) {
  const auto refused = [](void (*change)(HealthConfig&)) {
    HealthConfig config;
    change(config);
    return !config.valid();
  };
  EXPECT_TRUE(refused([](HealthConfig& c) { c.max_lidar_age = 0us; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.max_wheels_age = -1us; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.max_gyro_age = 0us; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.max_match_age = 0us; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.max_blind = c.max_wheels_age - 1us; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.initial_matches = 0; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.lost_rejections = c.degraded_rejections; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.max_position_variance_m2 = std::nanf(""); }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.recover_matches = 0; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.relocalised_matches = 0; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.recover_after = -1us; }));
  EXPECT_TRUE(refused([](HealthConfig& c) { c.overrun_hold = -1us; }));
}

}  // namespace
}  // namespace picolo
