// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/links.hpp"

#include <algorithm>
#include <array>

namespace picolo::inline v0::sim {

CanLink::CanLink(SimCanBus& bus, FaultPlan& faults, Device device, Timestamp start)
    : bus_(bus), faults_(faults), device_(device), start_(start) {}

void CanLink::send(const CanFrame& frame) {
  const FaultVerdict verdict = faults_.judge(device_, frame.stamp - start_);
  if (verdict.drop) { return; }
  CanFrame sent = frame;
  sent.stamp += verdict.delay;
  if (!held_.empty()) { sent.stamp = std::max(sent.stamp, held_.back().stamp); }
  if (verdict.corrupt && sent.length > 0) {
    faults_.corrupt(std::span<std::uint8_t>{sent.data}.first(sent.length));
  }
  static_cast<void>(held_.push(sent));
  if (verdict.duplicate) { static_cast<void>(held_.push(sent)); }
}

void CanLink::release(Timestamp until) {
  while (!held_.empty() && held_.front().stamp <= until) {
    bus_.deliver(held_.front());
    held_.pop();
  }
}

bool CanLink::suffers(FaultKind kind, Timestamp now) const {
  return faults_.active(device_, kind, now - start_);
}

SerialLink::SerialLink(SimSerialPort& port, FaultPlan& faults, Device device, Timestamp start)
    : port_(port), faults_(faults), device_(device), start_(start) {}

void SerialLink::send(std::span<const std::uint8_t> packet, Timestamp earliest) {
  std::array<std::uint8_t, 64> buffer{};
  const FaultVerdict verdict = faults_.judge(device_, earliest - start_);
  if (verdict.drop || packet.empty() || packet.size() > buffer.size()) { return; }
  const std::span<std::uint8_t> bytes = std::span<std::uint8_t>{buffer}.first(packet.size());
  std::copy(packet.begin(), packet.end(), bytes.begin());
  if (verdict.corrupt) { faults_.corrupt(bytes); }
  port_.deliver(bytes, earliest + verdict.delay);
  if (verdict.duplicate) { port_.deliver(bytes, earliest + verdict.delay); }
}

void SerialLink::update(Timestamp now) {
  const bool connected = !suffers(FaultKind::disconnect, now);
  if (connected != port_.connected()) { port_.set_connected(connected); }
}

bool SerialLink::suffers(FaultKind kind, Timestamp now) const {
  return faults_.active(device_, kind, now - start_);
}

}  // namespace picolo::inline v0::sim
