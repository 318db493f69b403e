// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/canopen_node.hpp"

#include <algorithm>
#include <bit>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0::sim {
namespace {

constexpr std::uint32_t kNmt = 0x000;
constexpr std::uint32_t kSync = 0x080;
constexpr std::uint32_t kTpdo1 = 0x180;
constexpr std::uint32_t kSdoRequest = 0x600;
constexpr std::uint32_t kHeartbeat = 0x700;

CanopenObjects objects_of(const CanopenNodeConfig& config) {
  return {config.node, config.heartbeat_period, config.syncs_per_pdo, config.with_velocity};
}

/// `counts` in [0, modulus).
std::uint32_t wrap(std::int64_t counts, std::uint64_t modulus) {
  const auto range = static_cast<std::int64_t>(modulus);
  const std::int64_t rest = counts % range;
  return static_cast<std::uint32_t>(rest < 0 ? rest + range : rest);
}

}  // namespace

CanopenNode::CanopenNode(const CanopenNodeConfig& config, EncoderSource& source, CanLink& link,
                         Timestamp power_up)
    : config_(config), objects_(objects_of(config)), source_(source), link_(link) {
  boot(power_up);
}

void CanopenNode::boot(Timestamp power_up) {
  state_ = NmtState::booting;
  objects_ = objects_of(config_);
  next_event_ = power_up + config_.boot_time;
  syncs_ = 0;
}

void CanopenNode::hear(const CanFrame& frame) {
  if (!powered_ || state_ == NmtState::booting || frame.extended || frame.remote) { return; }
  if (frame.id == kNmt && frame.length == 2) { network_management(frame); }
  if (frame.id == kSync && state_ == NmtState::operational) {
    ++syncs_;
    if (syncs_ < objects_.syncs_per_pdo()) { return; }
    syncs_ = 0;
    if (objects_.pdo_is_on()) { send_pdo(frame.stamp); }
  }
  if (frame.id == kSdoRequest + config_.node && state_ != NmtState::stopped) {
    link_.send(objects_.serve(frame));
  }
}

void CanopenNode::advance_to(Timestamp now) {
  if (link_.suffers(FaultKind::disconnect, now)) {
    powered_ = false;
    return;
  }
  if (!powered_) {
    powered_ = true;
    counts_at_power_up_ = source_.reading_at(now).counts;
    boot(now);
  }
  for (; next_event_ <= now; next_event_ += objects_.heartbeat_period()) {
    send_heartbeat(next_event_);
    if (state_ == NmtState::booting) { state_ = NmtState::pre_operational; }
  }
}

void CanopenNode::network_management(const CanFrame& frame) {
  const std::uint8_t addressee = frame.data[1];
  if (addressee != 0 && addressee != config_.node) { return; }
  switch (frame.data[0]) {
    case 0x01: state_ = NmtState::operational; break;
    case 0x02: state_ = NmtState::stopped; break;
    case 0x80: state_ = NmtState::pre_operational; break;
    case 0x81:
      counts_at_power_up_ = source_.reading_at(frame.stamp).counts;
      boot(frame.stamp);
      break;
    case 0x82: boot(frame.stamp); break;
    default: break;
  }
}

void CanopenNode::send_pdo(Timestamp sync) {
  if (!link_.suffers(FaultKind::freeze, sync)) { frozen_ = source_.reading_at(sync); }
  const std::int64_t turned = frozen_.counts - counts_at_power_up_;
  const std::int64_t counts = config_.initial_counts + (config_.reversed ? -turned : turned);
  const std::int64_t rate = config_.reversed ? -frozen_.counts_per_s : frozen_.counts_per_s;
  constexpr std::int64_t kLimit = 0x7FFF'FFFF;
  const auto velocity = static_cast<std::int32_t>(std::clamp(rate, -kLimit, kLimit));
  CanFrame pdo{.stamp = sync, .id = kTpdo1 + config_.node};
  for (const std::uint32_t object : objects_.mapped()) {
    store_u32_le(pdo.data, pdo.length,
                 object == kMappedPosition ? wrap(counts, config_.modulus)
                                           : std::bit_cast<std::uint32_t>(velocity));
    pdo.length = static_cast<std::uint8_t>(pdo.length + 4);
  }
  link_.send(pdo);
}

void CanopenNode::send_heartbeat(Timestamp when) {
  CanFrame heartbeat{.stamp = when, .id = kHeartbeat + config_.node, .length = 1};
  heartbeat.data[0] = static_cast<std::uint8_t>(state_);
  link_.send(heartbeat);
}

}  // namespace picolo::inline v0::sim
