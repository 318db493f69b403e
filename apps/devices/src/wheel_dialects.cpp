// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <deque>
#include <stdexcept>

#include "picolo/core/bytes.hpp"
#include "picolo/devices/dialects.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/odrive/odrive_messages.hpp"
#include "picolo/drivers/vesc/vesc_messages.hpp"

namespace picolo::inline v0::devices {
namespace {

/// Listens to the CANopen nodes as their master and repeats every sample in another protocol.
class WheelsDialect : public CanBus {
 public:
  WheelsDialect(CanBus& inner, Clock& clock, const WheelDialect& settings)
      : settings_(settings), inner_(inner), clock_(clock), wheels_(inner, config(settings)) {}
  virtual ~WheelsDialect() = default;

  Result<CanFrame> receive() override {
    while (pending_.empty()) {
      (void)wheels_.service(clock_.now());
      const Result<CanFrame> frame = inner_.receive();
      if (!frame) { return frame.status(); }
      if (!wheels_.consume(*frame)) { return frame; }
      const Result<WheelTicks> ticks = wheels_.take();
      if (ticks) { repeat(*ticks); }
    }
    const CanFrame frame = pending_.front();
    pending_.pop_front();
    return frame;
  }
  Status transmit(const CanFrame& frame) override { return inner_.transmit(frame); }
  [[nodiscard]] CanStatus status() const override { return inner_.status(); }

 protected:
  virtual void repeat(const WheelTicks& ticks) = 0;
  void say(CanFrame frame, const WheelTicks& ticks) {
    frame.stamp = ticks.stamp;
    frame.source = ticks.source;
    pending_.push_back(frame);
  }
  const WheelDialect settings_;

 private:
  static CanopenWheelsConfig config(const WheelDialect& settings) {
    CanopenWheelsConfig config = two_cia402_drives(settings.left_node, settings.right_node);
    config.produce_sync = true;
    return config;
  }
  CanBus& inner_;
  Clock& clock_;
  CanopenWheels wheels_;
  std::deque<CanFrame> pending_;
};

class OdriveDialect final : public WheelsDialect {
 public:
  using WheelsDialect::WheelsDialect;

 private:
  void repeat(const WheelTicks& ticks) override {
    for (std::size_t wheel = 0; wheel < 2; ++wheel) {
      const std::uint32_t node = wheel == 0 ? settings_.left_id : settings_.right_id;
      if (samples_ % 10 == 0) {
        CanFrame beat{.id = odrive_id(node, OdriveCommand::heartbeat), .length = 8};
        beat.data = {0, 0, 0, 0, 8, 0, 0, 0};
        say(beat, ticks);
      }
      CanFrame frame{.id = odrive_id(node, OdriveCommand::encoder_estimates), .length = 8};
      const float turns =
          static_cast<float>(ticks.ticks[wheel]) / static_cast<float>(settings_.counts_per_turn);
      store_u32_le(frame.data, 0, std::bit_cast<std::uint32_t>(turns));
      say(frame, ticks);
    }
    ++samples_;
  }
  std::uint32_t samples_ = 0;
};

class VescDialect final : public WheelsDialect {
 public:
  using WheelsDialect::WheelsDialect;

 private:
  void repeat(const WheelTicks& ticks) override {
    for (std::size_t wheel = 0; wheel < 2; ++wheel) {
      const std::uint32_t vesc = wheel == 0 ? settings_.left_id : settings_.right_id;
      CanFrame frame{.id = vesc_id(static_cast<std::uint8_t>(vesc & 0xFFU), VescCommand::status_5),
                     .extended = true,
                     .length = 8};
      const std::int64_t counts = ticks.ticks[wheel] * 6 *
                                  static_cast<std::int64_t>(settings_.pole_pairs) /
                                  static_cast<std::int64_t>(settings_.counts_per_turn);
      const auto bits = static_cast<std::uint32_t>(counts & 0xFFFFFFFF);
      for (std::size_t i = 0; i < 4; ++i) {
        frame.data[i] = static_cast<std::uint8_t>(bits >> (24 - 8 * i));
      }
      say(frame, ticks);
    }
  }
};

class DbcDialect final : public WheelsDialect {
 public:
  using WheelsDialect::WheelsDialect;

 private:
  void repeat(const WheelTicks& ticks) override {
    CanFrame frame{.id = 0x205, .length = 8};
    for (std::size_t wheel = 0; wheel < 2; ++wheel) {
      const auto angle = static_cast<std::uint32_t>(ticks.ticks[wheel] & 0x3FFF);
      frame.data[2 * wheel] = static_cast<std::uint8_t>(angle >> 8U);
      frame.data[2 * wheel + 1] = static_cast<std::uint8_t>(angle & 0xFFU);
    }
    say(frame, ticks);
  }
};

/// Nothing between the vehicle and the firmware.
class PassingBus final : public CanBus {
 public:
  explicit PassingBus(CanBus& inner) : inner_(inner) {}
  virtual ~PassingBus() = default;
  Result<CanFrame> receive() override { return inner_.receive(); }
  Status transmit(const CanFrame& frame) override { return inner_.transmit(frame); }
  [[nodiscard]] CanStatus status() const override { return inner_.status(); }

 private:
  CanBus& inner_;
};

/// CanBus has no public destructor: the deleter knows what it deletes.
template <typename Bus, typename... Args>
CanBusPointer make_bus(Args&&... args) {
  return CanBusPointer{new Bus(std::forward<Args>(args)...),
                       [](CanBus* bus) { delete static_cast<Bus*>(bus); }};
}

}  // namespace

CanBusPointer make_wheel_dialect(const std::string& name, CanBus& canopen, Clock& clock,
                                 const WheelDialect& settings) {
  if (name == "canopen") { return make_bus<PassingBus>(canopen); }
  if (name == "odrive") { return make_bus<OdriveDialect>(canopen, clock, settings); }
  if (name == "vesc") { return make_bus<VescDialect>(canopen, clock, settings); }
  if (name == "dbc") { return make_bus<DbcDialect>(canopen, clock, settings); }
  throw std::invalid_argument{"the simulated vehicle cannot speak '" + name +
                              "'; wheels: canopen, odrive, vesc, dbc"};
}

}  // namespace picolo::inline v0::devices
