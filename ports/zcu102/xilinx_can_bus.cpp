// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/zcu102/xilinx_can_bus.hpp"

#include "can_frame_words.hpp"
#include "picolo/zcu102/acceptance.hpp"
#include "registers.hpp"

namespace picolo::inline v0::zcu102 {
namespace {

// UG1085, chapter 20, and UG1087, module CAN.
constexpr std::uintptr_t kReset = 0x00;
constexpr std::uintptr_t kMode = 0x04;
constexpr std::uintptr_t kPrescaler = 0x08;
constexpr std::uintptr_t kBitTiming = 0x0C;
constexpr std::uintptr_t kErrorStatus = 0x14;
constexpr std::uintptr_t kStatus = 0x18;
constexpr std::uintptr_t kInterruptStatus = 0x1C;
constexpr std::uintptr_t kInterruptEnable = 0x20;
constexpr std::uintptr_t kInterruptClear = 0x24;
constexpr std::uintptr_t kSendFifo = 0x30;
constexpr std::uintptr_t kReceiveFifo = 0x50;
constexpr std::uintptr_t kFilterEnable = 0x60;
constexpr std::uintptr_t kFirstFilter = 0x64;  // a mask and an identifier each

constexpr std::uint32_t kSoftReset = 1U << 0;
constexpr std::uint32_t kCanEnable = 1U << 1;

constexpr std::uint32_t kModeSleep = 1U << 0;
constexpr std::uint32_t kModeLoopBack = 1U << 1;
constexpr std::uint32_t kModeSnoop = 1U << 2;

constexpr std::uint32_t kStatusConfiguration = 1U << 0;
constexpr std::uint32_t kStatusLoopBack = 1U << 1;
constexpr std::uint32_t kStatusSleep = 1U << 2;
constexpr std::uint32_t kStatusErrorWarning = 1U << 6;
constexpr std::uint32_t kStatusErrorPassive = 3U << 7;
constexpr std::uint32_t kStatusSendFull = 1U << 10;
constexpr std::uint32_t kStatusSnoop = 1U << 12;

constexpr std::uint32_t kSendFull = 1U << 2;
constexpr std::uint32_t kReceiveOverflow = 1U << 6;
constexpr std::uint32_t kReceiveNotEmpty = 1U << 7;
constexpr std::uint32_t kError = 1U << 8;
constexpr std::uint32_t kBusOff = 1U << 9;
constexpr std::uint32_t kServed = kReceiveOverflow | kReceiveNotEmpty | kError | kBusOff;

constexpr int kFifoFrames = 64;

struct BitTiming {
  std::uint32_t prescaler = 0;  ///< 1 to 256
  std::uint32_t before = 0;     ///< quanta of propagation and phase 1
  std::uint32_t after = 0;      ///< quanta of phase 2
};

/// Sample point at 7/8 of the bit or a little before. Prescaler 0: the rate cannot be met exactly.
BitTiming bit_timing(std::uint32_t clock_hz, std::uint32_t bit_rate) {
  for (std::uint32_t quanta = 18; quanta >= 8 && bit_rate > 0; --quanta) {
    const std::uint32_t rate = bit_rate * quanta;
    const std::uint32_t prescaler = clock_hz / rate;
    if (prescaler < 1 || prescaler > 256 || clock_hz % rate != 0) { continue; }
    const std::uint32_t after = (quanta + 7) / 8;
    return {prescaler, quanta - 1 - after, after};
  }
  return {};
}

std::uint32_t mode_bits(CanMode mode) {
  switch (mode) {
    case CanMode::listen_only: return kModeSnoop;
    case CanMode::loop_back: return kModeLoopBack;
    case CanMode::sleep:
    case CanMode::off:
    case CanMode::normal: break;
  }
  return 0;
}

}  // namespace

Status XilinxCanBus::open(std::span<const CanFilter> filters, CanMode mode) {
  const BitTiming timing = bit_timing(config_.clock_hz, config_.bit_rate);
  if (timing.prescaler == 0) { return Status::invalid_argument; }
  HardwareFilters merged;
  const Status status = merge_filters(filters, merged);
  if (!is_ok(status)) { return status; }

  const std::uintptr_t base = config_.base;
  reg(base, kReset) = kSoftReset;  // the rest may be written in configuration mode only
  reg(base, kPrescaler) = timing.prescaler - 1;
  reg(base, kBitTiming) = (timing.after - 1) << 4 | (timing.before - 1);
  reg(base, kFilterEnable) = 0;
  for (std::size_t i = 0; i < merged.size(); ++i) {
    const FilterWords words = to_words(merged[i]);
    reg(base, kFirstFilter + 8 * i) = words.mask;
    reg(base, kFirstFilter + 8 * i + 4) = words.id;
  }
  reg(base, kFilterEnable) = (1U << merged.size()) - 1;
  reg(base, kInterruptClear) = 0xFFFF'FFFF;
  bus_off_ = false;
  set_mode(mode);
  return Status::ok;
}

void XilinxCanBus::set_mode(CanMode mode) {
  const std::uintptr_t base = config_.base;
  wanted_ = mode;
  reg(base, kReset) = 0;
  reg(base, kMode) = mode_bits(mode);
  reg(base, kReset) = 0;  // QEMU forgets a mode only now, and would hold back what waits to be sent
  if (mode == CanMode::off) { return; }
  reg(base, kInterruptEnable) = kServed;
  reg(base, kReset) = kCanEnable;
  if (mode == CanMode::sleep) { reg(base, kMode) = kModeSleep; }  // from normal mode only
}

CanMode XilinxCanBus::mode() const {
  const std::uint32_t status = reg(config_.base, kStatus);
  if ((status & kStatusConfiguration) != 0) { return CanMode::off; }
  if ((status & kStatusLoopBack) != 0) { return CanMode::loop_back; }
  if ((status & kStatusSleep) != 0) { return CanMode::sleep; }
  return (status & kStatusSnoop) != 0 ? CanMode::listen_only : CanMode::normal;
}

void XilinxCanBus::on_interrupt() {
  const std::uintptr_t base = config_.base;
  const std::uint32_t pending = reg(base, kInterruptStatus);
  reg(base, kInterruptClear) = pending & (kReceiveOverflow | kError | kBusOff);
  if ((pending & kReceiveOverflow) != 0) { overflows_ = overflows_ + 1; }
  if ((pending & kError) != 0) {
    errors_ = errors_ + 1;
    reg(base, kErrorStatus) = 0xFFFF'FFFF;
  }
  for (int i = 0; i < kFifoFrames; ++i) {
    reg(base, kInterruptClear) = kReceiveNotEmpty;  // set again while a frame is left
    if ((reg(base, kInterruptStatus) & kReceiveNotEmpty) == 0) { break; }
    take_frame();
  }
  if ((pending & kBusOff) != 0) {
    bus_off_since_ = clock_.now();
    bus_off_ = true;
    reg(base, kReset) = 0;
  }
}

void XilinxCanBus::take_frame() {
  const std::uintptr_t base = config_.base;
  CanWords words;
  words.id = reg(base, kReceiveFifo);
  words.length = reg(base, kReceiveFifo + 4);
  words.data_high = reg(base, kReceiveFifo + 8);
  words.data_low = reg(base, kReceiveFifo + 12);
  CanFrame frame = to_frame(words);
  frame.stamp = clock_.now();
  frame.source = StampSource::hardware;
  static_cast<void>(received_.push(frame));  // the ring counts what it refuses
}

Result<CanFrame> XilinxCanBus::receive() {
  if (bus_off_ && clock_.now() - bus_off_since_ >= config_.restart_delay) {
    bus_off_ = false;
    ++counts_.restarts;
    set_mode(wanted_);
  }
  CanFrame frame;
  if (!received_.pop(frame)) {
    return wanted_ == CanMode::off ? Status::disconnected : Status::not_ready;
  }
  ++counts_.received;
  return frame;
}

bool XilinxCanBus::send_fifo_full() const {
  // QEMU shows a full FIFO in the interrupt status only, and sets that again while it is full.
  const std::uintptr_t base = config_.base;
  reg(base, kInterruptClear) = kSendFull;
  return (reg(base, kInterruptStatus) & kSendFull) != 0 ||
         (reg(base, kStatus) & kStatusSendFull) != 0;
}

Status XilinxCanBus::transmit(const CanFrame& frame) {
  if (frame.length > 8 || frame.id > (frame.extended ? 0x1FFF'FFFFU : 0x7FFU)) {
    return Status::invalid_argument;
  }
  if (wanted_ == CanMode::off) { return Status::disconnected; }
  if (bus_off_ || send_fifo_full()) {
    ++counts_.tx_refused;
    return Status::full;
  }
  const CanWords words = to_words(frame);
  const std::uintptr_t base = config_.base;
  reg(base, kSendFifo) = words.id;
  reg(base, kSendFifo + 4) = words.length;
  reg(base, kSendFifo + 8) = words.data_high;
  reg(base, kSendFifo + 12) = words.data_low;
  ++counts_.transmitted;
  return Status::ok;
}

CanStatus XilinxCanBus::status() const {
  CanStatus status = counts_;
  status.rx_lost = overflows_ + received_.dropped();
  status.error_frames = errors_;
  const std::uint32_t now = reg(config_.base, kStatus);
  if (bus_off_) {
    status.state = CanState::bus_off;
  } else if (wanted_ == CanMode::off) {
    status.state = CanState::absent;
  } else if ((now & kStatusErrorPassive) == kStatusErrorPassive) {
    status.state = CanState::passive;
  } else {
    status.state = (now & kStatusErrorWarning) != 0 ? CanState::warning : CanState::active;
  }
  return status;
}

}  // namespace picolo::inline v0::zcu102
