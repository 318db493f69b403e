// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/canopen_objects.hpp"

#include <algorithm>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0::sim {
namespace {

constexpr std::uint32_t kTpdo1 = 0x180;
constexpr std::uint32_t kSdoAnswer = 0x580;

// Index and subindex in one number.
constexpr std::uint32_t kHeartbeatTime = 0x1017'00;
constexpr std::uint32_t kPdoId = 0x1800'01;
constexpr std::uint32_t kPdoType = 0x1800'02;
constexpr std::uint32_t kMappedCount = 0x1A00'00;
constexpr std::uint32_t kFirstMapped = 0x1A00'01;

// CiA 301, abort codes.
constexpr std::uint32_t kUnknownCommand = 0x0504'0001;
constexpr std::uint32_t kUnsupportedAccess = 0x0601'0000;
constexpr std::uint32_t kNoSuchObject = 0x0602'0000;
constexpr std::uint32_t kCannotBeMapped = 0x0604'0041;
constexpr std::uint32_t kValueRange = 0x0609'0030;

}  // namespace

CanopenObjects::CanopenObjects(std::uint8_t node, Duration heartbeat_period,
                               std::uint8_t syncs_per_pdo, bool with_velocity)
    : node_(node),
      heartbeat_period_(heartbeat_period),
      pdo_id_(kTpdo1 + node),
      syncs_per_pdo_(syncs_per_pdo),
      mapped_(with_velocity ? 2 : 1) {}

CanFrame CanopenObjects::serve(const CanFrame& request) {
  CanFrame answer{.stamp = request.stamp, .id = kSdoAnswer + node_, .length = 8};
  std::copy_n(request.data.begin() + 1, 3, answer.data.begin() + 1);
  const std::uint32_t object = (std::uint32_t{request.data[2]} << 16) |
                               (std::uint32_t{request.data[1]} << 8) | request.data[3];
  const std::uint8_t command = request.data[0];
  std::uint32_t value = 0;
  std::uint32_t abort = kUnknownCommand;
  if (command == 0x40) {
    abort = read(object, value) ? 0 : kNoSuchObject;
    answer.data[0] = 0x43;
  } else if ((command & 0xF3U) == 0x23) {  // expedited, with size: 4 bytes less (bits 2 and 3)
    const std::size_t unused = (command >> 2) & 3U;
    abort = write(object, load_u32_le(request.data, 4) & (0xFFFF'FFFFU >> (8 * unused)));
    answer.data[0] = 0x60;
  }
  if (abort != 0) {
    answer.data[0] = 0x80;
    value = abort;
  }
  store_u32_le(answer.data, 4, value);
  return answer;
}

bool CanopenObjects::read(std::uint32_t object, std::uint32_t& value) const {
  switch (object) {
    case kHeartbeatTime:
      value = static_cast<std::uint32_t>(heartbeat_period_ / Duration{1ms});
      return true;
    case kPdoId: value = pdo_id_; return true;
    case kPdoType: value = syncs_per_pdo_; return true;
    case kMappedCount: value = static_cast<std::uint32_t>(mapped_); return true;
    case kFirstMapped:
    case kFirstMapped + 1: value = mapping_[object - kFirstMapped]; return true;
    default: return false;
  }
}

/// 0, or why not.
std::uint32_t CanopenObjects::write(std::uint32_t object, std::uint32_t value) {
  switch (object) {
    case kHeartbeatTime:
      if (value == 0 || value > 0xFFFF) { return kValueRange; }
      heartbeat_period_ = value * Duration{1ms};
      return 0;
    case kPdoId:
      // The identifier itself is fixed; bit 31 switches the TPDO off.
      if ((value & ~kOff) != kTpdo1 + node_) { return kValueRange; }
      pdo_id_ = value;
      return 0;
    case kPdoType:
      if (value < 1 || value > 240) { return kValueRange; }
      syncs_per_pdo_ = static_cast<std::uint8_t>(value);
      return 0;
    case kMappedCount: return write_count(value);
    case kFirstMapped:
    case kFirstMapped + 1:
      if (mapped_ != 0) { return kUnsupportedAccess; }
      if (value != kMappedPosition && value != kMappedVelocity) { return kCannotBeMapped; }
      mapping_[object - kFirstMapped] = value;
      return 0;
    default: return kNoSuchObject;
  }
}

std::uint32_t CanopenObjects::write_count(std::uint32_t count) {
  if (pdo_is_on()) { return kUnsupportedAccess; }
  if (count > mapping_.size()) { return kCannotBeMapped; }
  mapped_ = count;
  return 0;
}

}  // namespace picolo::inline v0::sim
