// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sensing/device_clock.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "picolo/core/random.hpp"

namespace picolo::test {
namespace {

static_assert(DeviceClockConfig{}.valid());
static_assert(!DeviceClockConfig{.wrap = 1s, .window = 500ms}.valid());

/// A device that counts milliseconds modulo 30 s, and whose data is on its way for a while.
struct Device {
  Duration start{29'900'000};  ///< of its counter when our clock stood at 5 s
  int drift_ppm = 0;
  [[nodiscard]] Duration counter(Timestamp measured) const {
    const Duration since = measured - Timestamp{5s};
    const Duration own = start + since + since * drift_ppm / 1'000'000;
    return own / 1ms * 1ms % Duration{30s};
  }
};

TEST(DeviceClock, GivenPerfectHostStampsThenTheyComeOutUntouchedOverManyWraps) {
  DeviceClock clock;
  const Device device;
  for (Timestamp t{5s}; t < Timestamp{200s}; t += 2667us) {
    ASSERT_EQ(clock.map(t, device.counter(t)), t);
  }
  EXPECT_EQ(clock.restarts(), 0U);
}

TEST(DeviceClock, GivenLateHostStampsThenTheResultLiesBetweenMeasurementAndHost) {
  for (const int drift_ppm : {-100, 0, 100}) {
    Random random{11};
    DeviceClock clock;
    const Device device{.drift_ppm = drift_ppm};
    Duration worst{};
    for (int k = 0; k < 40'000; ++k) {
      const Timestamp measured = Timestamp{5s} + k * 2667us;
      const Timestamp host =
          measured + Duration{random.below(16'000)};  // a USB adapter's latency timer
      const Timestamp mapped = clock.map(host, device.counter(measured));
      ASSERT_LE(mapped, host);
      ASSERT_GE(mapped, measured);
      if (k > 200) { worst = std::max(worst, mapped - measured); }
    }
    EXPECT_LT(worst, 3ms) << drift_ppm;  // against 16 ms of the host
    EXPECT_EQ(clock.restarts(), 0U);
  }
}

TEST(DeviceClock, GivenAnyJitterThenEveryDevicesStampsHaveNoMoreOfItOverTheWrap) {
  struct Counter {
    const char* device;
    Duration wrap;
    Duration resolution;
  };
  for (const Counter& counter : {Counter{"ld06", 30s, 1ms}, Counter{"scip", 16'777'216ms, 1ms},
                                 Counter{"xsens", (1LL << 32U) * 100us, 100us}}) {
    for (const std::uint32_t jitter_us : {1U, 100U, 900U, 5000U, 30'000U}) {
      for (const int drift_ppm : {-100, 100}) {
        SCOPED_TRACE(std::string{counter.device} + " " + std::to_string(jitter_us) + " us");
        Random random{jitter_us};
        DeviceClock clock{{.wrap = counter.wrap, .resolution = counter.resolution}};
        Duration shortest = Duration::max();
        Duration longest = Duration::min();
        Timestamp last{};
        for (int k = 0; k < 4000; ++k) {
          const Duration since = k * 2500us;
          const Timestamp host = Timestamp{5s} + since + Duration{random.below(jitter_us)};
          const Duration own = counter.wrap - 5s + since + since * drift_ppm / 1'000'000;
          const Duration shown = own / counter.resolution * counter.resolution % counter.wrap;
          const Timestamp mapped = clock.map(std::max(host, last), shown);
          last = std::max(host, last);  // bytes come in order
          shortest = std::min(shortest, mapped - (Timestamp{5s} + since));
          longest = std::max(longest, mapped - (Timestamp{5s} + since));
        }
        EXPECT_GE(shortest, Duration{0});
        EXPECT_LT(longest, Duration{jitter_us});
        EXPECT_EQ(clock.restarts(), 0U);
      }
    }
  }
}

TEST(DeviceClock, GivenACounterThatStandsStillThenTheHostDecides) {
  DeviceClock clock;
  for (Timestamp t{5s}; t < Timestamp{8s}; t += 2667us) { ASSERT_EQ(clock.map(t, 0ms), t); }
  EXPECT_GT(clock.restarts(), 0U);
}

TEST(DeviceClock, GivenADeviceThatRestartsThenNothingIsEarlyAndItFindsItsWay) {
  DeviceClock clock;
  Device device{.start = 12s};
  Timestamp t{5s};
  for (; t < Timestamp{7s}; t += 2667us) { ASSERT_EQ(clock.map(t, device.counter(t)), t); }
  device.start = Duration{3s} - (t - Timestamp{5s});
  for (; t < Timestamp{12s}; t += 2667us) { ASSERT_EQ(clock.map(t, device.counter(t)), t); }
  // and late stamps are still taken back
  EXPECT_LE(clock.map(t + 10ms, device.counter(t)), t + 2ms);
}

TEST(DeviceClock, GivenALongSilenceThenItBeginsAnew) {
  DeviceClock clock;
  const Device device;
  EXPECT_EQ(clock.map(Timestamp{5s}, device.counter(Timestamp{5s})), Timestamp{5s});
  const Timestamp later{5s + 35s};  // more than a wrap: how many is not known
  EXPECT_EQ(clock.map(later, device.counter(later)), later);
  EXPECT_EQ(clock.restarts(), 1U);
}

TEST(DeviceClock, GivenASilenceOfSecondsThenWhatWasMeasuredBeforeItNoLongerCounts) {
  DeviceClock clock;
  const Device device{.drift_ppm = -2000};  // far beyond what is configured
  EXPECT_EQ(clock.map(Timestamp{5s}, device.counter(Timestamp{5s})), Timestamp{5s});
  const Timestamp later{9s};
  EXPECT_EQ(clock.map(later, device.counter(later)), later);
  EXPECT_EQ(clock.restarts(), 0U);
}

TEST(DeviceClock, GivenACounterAtAThirdOfItsRateThenTheErrorStaysBoundedAndIsCounted) {
  DeviceClock clock;
  for (Timestamp t{5s}; t < Timestamp{20s}; t += 10ms) {
    const Duration slow = (t - Timestamp{5s}) / 3 / 1ms * 1ms;
    const Timestamp mapped = clock.map(t, slow);
    ASSERT_LE(mapped, t);
    ASSERT_GE(mapped, t - DeviceClockConfig{}.max_lateness);
  }
  EXPECT_GT(clock.restarts(), 10U);
}

TEST(DeviceClock, GivenACounterBeyondItsWrapThenItIsTakenModuloTheWrap) {
  DeviceClock clock;
  EXPECT_EQ(clock.map(Timestamp{5s}, 31s), Timestamp{5s});
  EXPECT_LE(clock.map(Timestamp{5s} + 20ms, 1s + 1ms), Timestamp{5s} + 3ms);
}

}  // namespace
}  // namespace picolo::test
