// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/linux/kernel_stamps.hpp"

#include <sys/socket.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cstring>

namespace picolo::inline v0 {
namespace {

constexpr Duration kSlack = 1ms;
constexpr std::int64_t kSlackNs = 1'000'000;

std::int64_t nanoseconds(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1'000'000'000 + time.tv_nsec;
}

std::int64_t read_ns(clockid_t clock) {
  timespec time{};
  static_cast<void>(clock_gettime(clock, &time));
  return nanoseconds(time);
}

Timestamp to_monotonic(std::int64_t realtime_ns, std::int64_t offset_ns) {
  return Timestamp{Duration{(realtime_ns - offset_ns) / 1000}};
}

}  // namespace

KernelStamps kernel_stamps(msghdr& message) {
  KernelStamps stamps;
  for (cmsghdr* header = CMSG_FIRSTHDR(&message); header != nullptr;
       header = CMSG_NXTHDR(&message, header)) {
    if (header->cmsg_level != SOL_SOCKET) { continue; }
    // Software, transformed, hardware; software alone with SO_TIMESTAMPNS.
    std::array<timespec, 3> times{};
    const bool alone = header->cmsg_type == SCM_TIMESTAMPNS;
    if (!alone && header->cmsg_type != SCM_TIMESTAMPING) { continue; }
    std::memcpy(times.data(), CMSG_DATA(header), alone ? sizeof times[0] : sizeof times);
    if (nanoseconds(times[0]) != 0) { stamps.realtime_ns = nanoseconds(times[0]); }
    stamps.hardware_ns = std::max(stamps.hardware_ns, nanoseconds(times[2]));
  }
  return stamps;
}

std::int64_t realtime_minus_monotonic_ns() {
  // Wall time between two readings of the monotonic clock: an interruption in between costs at most
  // half of itself.
  const std::int64_t before = read_ns(CLOCK_MONOTONIC);
  const std::int64_t realtime = read_ns(CLOCK_REALTIME);
  const std::int64_t after = read_ns(CLOCK_MONOTONIC);
  return realtime - before - (after - before) / 2;
}

void StampMapper::reset(Timestamp now) {
  draining_ = false;
  previous_end_ = now;
}

void StampMapper::begin_drain(std::int64_t realtime_minus_monotonic_ns) {
  const std::int64_t step = realtime_minus_monotonic_ns - offset_ns_;
  if (has_offset_ && (step > kSlackNs || step < -kSlackNs)) {
    ++clock_steps_;
    previous_offset_ns_ = offset_ns_;
  }
  if (!has_offset_) { previous_offset_ns_ = realtime_minus_monotonic_ns; }
  offset_ns_ = realtime_minus_monotonic_ns;
  has_offset_ = true;
  draining_ = true;
}

void StampMapper::end_drain(Timestamp now) {
  draining_ = false;
  previous_end_ = now;
}

bool StampMapper::fits(std::int64_t realtime_ns, std::int64_t offset_ns, Timestamp now) const {
  const Timestamp mapped = to_monotonic(realtime_ns, offset_ns);
  return mapped >= previous_end_ - kSlack && mapped <= now + kSlack;
}

bool StampMapper::wants_offset(const KernelStamps& stamps, Timestamp now) const {
  return stamps.realtime_ns != 0 && !fits(stamps.realtime_ns, offset_ns_, now) &&
         !fits(stamps.realtime_ns, previous_offset_ns_, now);
}

MappedStamp StampMapper::map(const KernelStamps& stamps, Timestamp now) {
  MappedStamp mapped{.stamp = now, .source = StampSource::read};
  if (stamps.realtime_ns != 0) { mapped = map_realtime(stamps.realtime_ns, now); }
  if (stamps.hardware_ns != 0) {
    mapped = {.stamp = hardware_.map(mapped.stamp, Duration{stamps.hardware_ns / 1000}),
              .source = StampSource::hardware};
  }
  mapped.stamp = std::clamp(mapped.stamp, std::min(last_, now), now);
  last_ = mapped.stamp;
  return mapped;
}

MappedStamp StampMapper::map_realtime(std::int64_t realtime_ns, Timestamp now) {
  for (const std::int64_t offset_ns : {offset_ns_, previous_offset_ns_}) {
    if (fits(realtime_ns, offset_ns, now)) {
      return {.stamp = to_monotonic(realtime_ns, offset_ns), .source = StampSource::kernel};
    }
  }
  ++misfits_;
  return {.stamp = now, .source = StampSource::read};
}

}  // namespace picolo::inline v0
