// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Any frames into the drivers of CAN encoders.
#include <array>

#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/dbc/dbc_wheels.hpp"
#include "picolo/drivers/odrive/odrive_wheels.hpp"
#include "picolo/drivers/vesc/vesc_wheels.hpp"
#include "targets.hpp"

namespace picolo::fuzz {
namespace {

/// Takes everything, says nothing.
class DeafBus final : public CanBus {
 public:
  Result<CanFrame> receive() override { return Status::not_ready; }
  Status transmit(const CanFrame& frame) override {
    require(frame.length <= 8 && frame.id <= (frame.extended ? 0x1FFFFFFFU : 0x7FFU),
            "a frame that no bus would take");
    ++sent;
    return sent % 5 == 0 ? Status::full : Status::ok;
  }
  [[nodiscard]] CanStatus status() const override { return {}; }
  std::uint32_t sent = 0;
};

/// Nine bytes a frame and more: kind, identifier, length, data. Half of the identifiers are those
/// that the driver listens to.
template <typename Wheels>
void feed(Wheels& wheels, Reader& reader) {
  const auto filters = wheels.filters();
  Timestamp now{1s};
  Timestamp last = Timestamp::min();
  while (!reader.empty()) {
    const std::uint8_t kind = reader.byte();
    CanFrame frame{.id = reader.word(2)};
    frame.extended = (kind & 1U) != 0;
    frame.remote = (kind & 0x70U) == 0x70U;
    if ((kind & 2U) != 0 && filters.size() > 0) {
      const CanFilter& filter = filters.begin()[frame.id % filters.size()];
      frame.id = filter.id;
      frame.extended = filter.extended;
    }
    now += Duration{(kind >> 2U) * 700};
    frame.stamp = now;
    frame.length = static_cast<std::uint8_t>(reader.byte() % 9U);
    for (std::size_t i = 0; i < frame.length; ++i) { frame.data[i] = reader.byte(); }
    (void)wheels.consume(frame);
    const Result<WheelTicks> ticks = wheels.take();
    if (ticks) {
      require(ticks->stamp >= last, "stamps of wheels run backwards");
      last = ticks->stamp;
    }
    (void)wheels.service(now);
  }
}

void canopen_wheels(Input input) {
  Reader reader{input};
  DeafBus bus;
  const std::uint8_t choice = reader.byte();
  CanopenWheelsConfig config =
      (choice & 1U) != 0 ? dual_cia402_drive(5) : two_cia406_encoders(3, 4, 1'000'003);
  config.setup.enabled = (choice & 2U) != 0;
  config.produce_sync = (choice & 4U) != 0;
  CanopenWheels wheels{bus, config};
  feed(wheels, reader);
}

void odrive(Input input) {
  Reader reader{input};
  DeafBus bus;
  const std::uint8_t choice = reader.byte();
  OdriveWheels wheels{bus,
                      {.firmware = static_cast<OdriveFirmware>(choice % 3U),
                       .position = static_cast<OdrivePosition>((choice >> 2U) & 1U)}};
  feed(wheels, reader);
}

void vesc(Input input) {
  Reader reader{input};
  VescWheels wheels{{}};
  feed(wheels, reader);
}

void dbc(Input input) {
  Reader reader{input};
  DbcWheelsConfig config;
  for (std::size_t i = 0; i < 2; ++i) {
    DbcWheelConfig& wheel = config.wheels[i];
    wheel.id = 0x205;
    wheel.frame_bytes = static_cast<std::uint8_t>(reader.byte() % 9U);
    wheel.signal = {.start_bit = reader.byte(),
                    .length = reader.byte(),
                    .big_endian = (reader.byte() & 1U) != 0,
                    .type = static_cast<DbcType>(reader.byte() % 4U)};
    wheel.quantity = static_cast<DbcQuantity>(reader.byte() & 1U);
    wheel.rules.checksum = static_cast<DbcChecksum>(reader.byte() % 4U);
    wheel.counter.modulus = 2 + reader.word(3);
  }
  if (!config.valid()) { return; }
  DbcWheels wheels{config};
  feed(wheels, reader);
}

}  // namespace

std::vector<Target> can_targets() {
  return {{"canopen", canopen_wheels, true},
          {"odrive", odrive, true},
          {"vesc", vesc, true},
          {"dbc-wheels", dbc, true}};
}

}  // namespace picolo::fuzz
