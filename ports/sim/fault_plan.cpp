// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/fault_plan.hpp"

#include <algorithm>
#include <utility>

namespace picolo::inline v0::sim {
namespace {

constexpr std::uint64_t kFirstStream = 100;

template <std::size_t... Index>
std::array<Random, sizeof...(Index)> make_streams(std::uint64_t seed,
                                                  std::index_sequence<Index...>) {
  return {Random{seed, kFirstStream + Index}...};
}

bool concerns(const Fault& fault, Device device, Duration elapsed) {
  const bool same = fault.device == device || fault.device == Device::can_bus;
  const bool on_bus = device == Device::wheel_left || device == Device::wheel_right;
  if (!same || (fault.device == Device::can_bus && !on_bus && device != Device::can_bus)) {
    return false;
  }
  return elapsed >= fault.begin && elapsed < fault.end;
}

}  // namespace

FaultPlan::FaultPlan(std::uint64_t seed, const FaultList& faults)
    : faults_(faults),
      streams_(make_streams(seed, std::make_index_sequence<kMaxFaults>{})),
      bits_(seed, kFirstStream + kMaxFaults) {}

FaultVerdict FaultPlan::judge(Device device, Duration elapsed) {
  FaultVerdict verdict;
  for (std::size_t i = 0; i < faults_.size(); ++i) {
    const Fault& fault = faults_[i];
    if (!concerns(fault, device, elapsed)) { continue; }
    if (fault.kind == FaultKind::silence) { verdict.drop = true; }
    if (fault.kind == FaultKind::disconnect && fault.device != Device::can_bus) {
      verdict.drop = true;
    }
    const bool strikes = streams_[i].uniform_f32() < fault.probability;
    if (!strikes) { continue; }
    if (fault.kind == FaultKind::drop) { verdict.drop = true; }
    if (fault.kind == FaultKind::corrupt) { verdict.corrupt = true; }
    if (fault.kind == FaultKind::duplicate) { verdict.duplicate = true; }
    if (fault.kind == FaultKind::delay) { verdict.delay = std::max(verdict.delay, fault.delay); }
  }
  FaultCounters& counters = counters_[static_cast<std::size_t>(device)];
  if (verdict.drop) {
    ++counters.dropped;
    return {.drop = true};
  }
  if (verdict.corrupt) { ++counters.corrupted; }
  if (verdict.duplicate) { ++counters.duplicated; }
  if (verdict.delay > Duration{0}) { ++counters.delayed; }
  return verdict;
}

bool FaultPlan::active(Device device, FaultKind kind, Duration elapsed) const {
  return std::any_of(faults_.begin(), faults_.end(), [&](const Fault& fault) {
    return fault.kind == kind && concerns(fault, device, elapsed) &&
           (fault.device == device || kind != FaultKind::disconnect);
  });
}

void FaultPlan::corrupt(std::span<std::uint8_t> bytes) {
  const std::uint32_t flips = 1 + bits_.below(3);
  for (std::uint32_t i = 0; i < flips; ++i) {
    const std::uint32_t bit = bits_.below(static_cast<std::uint32_t>(8 * bytes.size()));
    std::uint8_t& byte = bytes[bit / 8];
    byte = static_cast<std::uint8_t>(byte ^ (1U << (bit % 8)));
  }
}

const FaultCounters& FaultPlan::counters(Device device) const {
  return counters_[static_cast<std::size_t>(device)];
}

}  // namespace picolo::inline v0::sim
