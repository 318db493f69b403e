// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Stamps of the kernel and of controllers, brought to the monotonic clock: by scenario, without a
// kernel.

#include "picolo/linux/kernel_stamps.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace picolo {
namespace {

constexpr std::int64_t kOffsetNs = 1'700'000'000'000'000'000;  // 2023
constexpr std::int64_t kHourNs = 3'600'000'000'000;

std::int64_t nanoseconds(Timestamp time) {
  return time.time_since_epoch().count() * 1000;
}

/// A kernel stamp of this monotonic instant, with the wall clock at `offset_ns`.
KernelStamps at(Timestamp time, std::int64_t offset_ns = kOffsetNs) {
  return {.realtime_ns = nanoseconds(time) + offset_ns};
}

class KernelStampsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    mapper.reset(now);
    empty_drain(kOffsetNs);
  }
  void empty_drain(std::int64_t offset_ns) {
    mapper.begin_drain(offset_ns);
    now += 5ms;
    mapper.end_drain(now);
  }
  void expect_kernel(const MappedStamp& mapped, Timestamp stamp) const {
    EXPECT_EQ(mapped.source, StampSource::kernel);
    EXPECT_EQ(mapped.stamp, stamp);
  }

  StampMapper mapper;
  Timestamp now{100s};
};

/// Control messages as the kernel lays them out.
class Control {
 public:
  template <typename T>
  void add(int type, const T& value) {
    cmsghdr header{};
    header.cmsg_level = SOL_SOCKET;
    header.cmsg_type = type;
    header.cmsg_len = CMSG_LEN(sizeof value);
    std::memcpy(bytes_.data() + size_, &header, sizeof header);
    std::memcpy(bytes_.data() + size_ + CMSG_LEN(0), &value, sizeof value);
    size_ += CMSG_SPACE(sizeof value);
  }
  KernelStamps stamps() {
    msghdr message{};
    message.msg_control = bytes_.data();
    message.msg_controllen = size_;
    return kernel_stamps(message);
  }

 private:
  alignas(cmsghdr) std::array<std::uint8_t, 256> bytes_{};
  std::size_t size_ = 0;
};

TEST(KernelStampsOfADatagram, AreReadFromItsControlMessages) {
  Control none;
  none.add(SO_RXQ_OVFL, std::uint32_t{7});
  EXPECT_EQ(none.stamps().realtime_ns, 0);
  EXPECT_EQ(none.stamps().hardware_ns, 0);

  Control software;
  software.add(SCM_TIMESTAMPNS, timespec{.tv_sec = 5, .tv_nsec = 6});
  EXPECT_EQ(software.stamps().realtime_ns, 5'000'000'006);
  EXPECT_EQ(software.stamps().hardware_ns, 0);

  Control both;
  both.add(SO_RXQ_OVFL, std::uint32_t{7});
  both.add(SCM_TIMESTAMPNS, timespec{.tv_sec = 5, .tv_nsec = 6});
  both.add(SCM_TIMESTAMPING, std::array<timespec, 3>{{{5, 6}, {0, 0}, {7, 8}}});
  EXPECT_EQ(both.stamps().realtime_ns, 5'000'000'006);
  EXPECT_EQ(both.stamps().hardware_ns, 7'000'000'008);

  Control hardware_only;
  hardware_only.add(SCM_TIMESTAMPING, std::array<timespec, 3>{{{0, 0}, {0, 0}, {7, 8}}});
  EXPECT_EQ(hardware_only.stamps().realtime_ns, 0);
  EXPECT_EQ(hardware_only.stamps().hardware_ns, 7'000'000'008);
}

TEST_F(KernelStampsTest, GivenAStampOfThisDrainThenItIsMapped) {
  now += 5ms;
  mapper.begin_drain(kOffsetNs);
  expect_kernel(mapper.map(at(now - 2ms), now), now - 2ms);
  EXPECT_EQ(mapper.clock_steps(), 0U);
}

TEST_F(KernelStampsTest, GivenNoStampThenItIsTheTimeOfTheRead) {
  mapper.begin_drain(kOffsetNs);
  const MappedStamp mapped = mapper.map({}, now);
  EXPECT_EQ(mapped.source, StampSource::read);
  EXPECT_EQ(mapped.stamp, now);
  EXPECT_EQ(mapper.misfits(), 0U);
}

TEST_F(KernelStampsTest, GivenAStepThenFramesFromBeforeAndAfterItKeepTheirStamps) {
  for (const std::int64_t step_ns : {kHourNs, -kHourNs}) {
    empty_drain(kOffsetNs);
    const Timestamp before = now + 1ms;
    const Timestamp after = now + 3ms;
    now += 5ms;
    mapper.begin_drain(kOffsetNs + step_ns);
    expect_kernel(mapper.map(at(before), now), before);
    expect_kernel(mapper.map(at(after, kOffsetNs + step_ns), now), after);
    mapper.end_drain(now);
  }
  EXPECT_EQ(mapper.clock_steps(), 3U);  // there, back, there
  EXPECT_EQ(mapper.misfits(), 0U);
}

TEST_F(KernelStampsTest, GivenAStepWithinTheDrainThenANewOffsetIsAskedForAndFits) {
  now += 5ms;
  mapper.begin_drain(kOffsetNs);
  EXPECT_FALSE(mapper.wants_offset(at(now), now));
  const KernelStamps stepped = at(now, kOffsetNs + kHourNs);
  EXPECT_TRUE(mapper.wants_offset(stepped, now));
  mapper.begin_drain(kOffsetNs + kHourNs);
  EXPECT_FALSE(mapper.wants_offset(stepped, now));
  expect_kernel(mapper.map(stepped, now), now);
}

TEST_F(KernelStampsTest, GivenAStampThatFitsNothingThenItIsTheTimeOfTheReadAndCounted) {
  now += 5ms;
  mapper.begin_drain(kOffsetNs);
  const MappedStamp mapped = mapper.map(at(now - 1h), now);
  EXPECT_EQ(mapped.source, StampSource::read);
  EXPECT_EQ(mapped.stamp, now);
  EXPECT_EQ(mapper.misfits(), 1U);
}

TEST_F(KernelStampsTest, GivenStampsOutOfOrderThenTheyNeverDecreaseNorPassNow) {
  now += 5ms;
  mapper.begin_drain(kOffsetNs);
  EXPECT_EQ(mapper.map(at(now - 1ms), now).stamp, now - 1ms);
  EXPECT_EQ(mapper.map(at(now - 3ms), now).stamp, now - 1ms);
  EXPECT_EQ(mapper.map(at(now + 500us), now).stamp, now);
}

// The controller stamps frames every 10 ms to the microsecond, from a clock that runs 20 ppm fast;
// the kernel sees them 50 us to 850 us later.
TEST_F(KernelStampsTest, GivenAControllersStampsThenTheKernelsLatenessIsTakenAway) {
  Timestamp last_true = now;
  Duration worst{};
  for (int i = 1; i <= 500; ++i) {
    const Timestamp true_time = last_true + 10ms;
    last_true = true_time;
    const Duration lateness = 50us + Duration{(i * 7919) % 800};
    now = true_time + 1ms;
    mapper.begin_drain(kOffsetNs);
    KernelStamps stamps = at(true_time + lateness);
    stamps.hardware_ns = 5'000'000'000 + std::int64_t{i} * 10'000'200;
    const MappedStamp mapped = mapper.map(stamps, now);
    mapper.end_drain(now - 900us);
    EXPECT_EQ(mapped.source, StampSource::hardware);
    if (i > 50) { worst = std::max(worst, mapped.stamp - true_time); }
    EXPECT_GE(mapped.stamp, true_time);
  }
  EXPECT_LE(worst, 150us);
}

}  // namespace
}  // namespace picolo
