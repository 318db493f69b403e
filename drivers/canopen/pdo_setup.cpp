// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/canopen/pdo_setup.hpp"

namespace picolo::inline v0::canopen {
namespace {

constexpr std::uint16_t kHeartbeatTime = 0x1017;
constexpr std::uint16_t kMappingOffset = 0x200;  // 0x1A00 belongs to 0x1800
constexpr std::uint32_t kInvalid = 0x80000000U;

enum Step : int { heartbeat, invalidate, type, timer, clear, map };

}  // namespace

PdoSetup::PdoSetup(std::uint8_t node, int number, std::uint16_t cob_id, const PdoMapping& mapping,
                   const PdoSetupConfig& config)
    : config_(config),
      sdo_(node, config.answer_timeout),
      mapping_(mapping),
      cob_id_(cob_id),
      parameters_(static_cast<std::uint16_t>(0x1800 + number - 1)) {}

std::size_t PdoSetup::fields() const {
  std::size_t count = 0;
  while (count < mapping_.size() && mapping_[count].bits != 0) { ++count; }
  return count;
}

void PdoSetup::restart() {
  step_ = 0;
  asked_ = false;
  on_bus_ = false;
  not_before_ = Timestamp::min();
}

/// False: this step has nothing to write.
bool PdoSetup::request(int step) {
  const auto mapping = static_cast<std::uint16_t>(parameters_ + kMappingOffset);
  const auto count = static_cast<int>(fields());
  if (step == heartbeat) {
    if (config_.heartbeat_ms == 0) { return false; }
    sdo_.write(kHeartbeatTime, 0, config_.heartbeat_ms, 2);
  } else if (step == invalidate) {
    sdo_.write(parameters_, 1, cob_id_ | kInvalid, 4);
  } else if (step == type) {
    sdo_.write(parameters_, 2, config_.transmission_type, 1);
  } else if (step == timer) {
    if (config_.event_timer_ms == 0) { return false; }
    sdo_.write(parameters_, 5, config_.event_timer_ms, 2);
  } else if (step == clear) {
    sdo_.write(mapping, 0, 0, 1);
  } else if (step < map + count) {
    const MappedObject& object = mapping_[static_cast<std::size_t>(step - map)];
    const std::uint32_t entry = (static_cast<std::uint32_t>(object.index) << 16U) |
                                (static_cast<std::uint32_t>(object.subindex) << 8U) | object.bits;
    sdo_.write(mapping, static_cast<std::uint8_t>(step - map + 1), entry, 4);
  } else if (step == map + count) {
    sdo_.write(mapping, 0, static_cast<std::uint32_t>(count), 1);
  } else {
    sdo_.write(parameters_, 1, cob_id_, 4);
  }
  return true;
}

void PdoSetup::advance() {
  const int last = map + static_cast<int>(fields()) + 1;
  asked_ = false;
  on_bus_ = false;
  step_ = step_ == last ? kDone : step_ + 1;
}

bool PdoSetup::next(Timestamp now, CanFrame& frame) {
  if (done() || now < not_before_) { return false; }
  sdo_.service(now);
  if (asked_ && sdo_.state() == SdoState::done) { advance(); }
  if (asked_ && sdo_.state() != SdoState::waiting) {
    // Refused or silent: from the beginning, since it may have lost power in between.
    ++failures_;
    abort_code_ = sdo_.state() == SdoState::aborted ? sdo_.value() : 0;
    restart();
    not_before_ = now + config_.retry;
    return false;
  }
  while (!asked_ && step_ != kDone) {
    if (request(step_)) {
      asked_ = true;
    } else {
      advance();
    }
  }
  if (step_ == kDone || on_bus_) { return false; }
  frame = sdo_.frame();
  return true;
}

void PdoSetup::sent(Timestamp now) {
  on_bus_ = true;
  sdo_.sent(now);
}

bool PdoSetup::consume(const CanFrame& frame) {
  return on_bus_ && sdo_.consume(frame);
}

}  // namespace picolo::inline v0::canopen
