// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "vehicle.hpp"

#include <array>

#include "picolo/controller/controller_config.hpp"

namespace picolo {
namespace {

constexpr std::uint32_t kBase = FramesOutConfig{}.base_id;
constexpr std::uint32_t kForeign = 0x2A5;

/// A CANopen function code, whatever the node.
constexpr bool is(const CanFrame& frame, std::uint32_t function) {
  return (frame.id & ~0x7FU) == function && (frame.id & 0x7FU) != 0;
}

}  // namespace

void VehicleOnWires::live(Timestamp now) {
  take_from_controller();
  simulation_.advance_to(now);
  send_frames(now);
  send_bytes(simulation_.lidar_port(), lidar_);
  send_bytes(simulation_.imu_port(), imu_);
}

void VehicleOnWires::take_from_controller() {
  while (const Result<CanFrame> frame = can_.receive()) {
    heard_.starts += frame->id == 0x000 && frame->data[0] == 0x01 ? 1U : 0U;
    heard_.syncs += frame->id == 0x080 ? 1U : 0U;
    heard_.service_requests += is(*frame, 0x600) ? 1U : 0U;
    heard_.from_controller += (frame->id & ~0xFU) == kBase ? 1U : 0U;
    if (frame->id == kBase) { pose_frame_ = *frame; }
    static_cast<void>(simulation_.can().transmit(*frame));
  }
}

void VehicleOnWires::send_frames(Timestamp now) {
  while (const Result<CanFrame> frame = simulation_.can().receive()) {
    const bool heartbeat = is(*frame, 0x700);
    heard_.boot_ups += heartbeat && frame->data[0] == 0 ? 1U : 0U;
    heard_.heartbeats += heartbeat && frame->data[0] != 0 ? 1U : 0U;
    heard_.service_answers += is(*frame, 0x580) ? 1U : 0U;
    heard_.service_aborts += is(*frame, 0x580) && frame->data[0] == 0x80 ? 1U : 0U;
    heard_.process_data += is(*frame, 0x180) ? 1U : 0U;
    send(*frame);
  }
  if (now >= next_foreign_) {
    next_foreign_ = now + 5ms;
    ++heard_.foreign;
    send({.id = kForeign, .length = 8});
  }
}

void VehicleOnWires::send_bytes(sim::SimSerialPort& from, SerialPort& to) {
  std::array<std::uint8_t, 64> bytes{};
  while (const Result<SerialRead> read = from.read(bytes)) {
    const Result<std::size_t> taken = to.write(std::span{bytes}.first(read->size));
    refused_ += static_cast<std::uint32_t>(read->size - (taken ? *taken : 0));
  }
}

void VehicleOnWires::send(const CanFrame& frame) {
  refused_ += is_ok(can_.transmit(frame)) ? 0U : 1U;
}

}  // namespace picolo
