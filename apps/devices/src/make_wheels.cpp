// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>

#include "counters.hpp"
#include "picolo/devices/dbc_file.hpp"
#include "picolo/devices/registry.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/dbc/dbc_wheels.hpp"
#include "picolo/drivers/odrive/odrive_wheels.hpp"
#include "picolo/drivers/vesc/vesc_wheels.hpp"

namespace picolo::inline v0::devices {
namespace {

/// Any encoder driver: consume, take, service, filters, counters.
template <typename Driver>
class CanWheels final : public Wheels {
 public:
  template <typename... Args>
  explicit CanWheels(Args&&... args) : driver_(std::forward<Args>(args)...) {}
  bool consume(const CanFrame& frame) override { return driver_.consume(frame); }
  Result<WheelTicks> take() override { return driver_.take(); }
  Status service(Timestamp now) override { return driver_.service(now); }
  [[nodiscard]] std::vector<CanFilter> filters() const override {
    const auto filters = driver_.filters();
    return {filters.begin(), filters.end()};
  }
  [[nodiscard]] Counters counters() const override { return to_list(driver_.counters()); }

 private:
  Driver driver_;
};

[[noreturn]] void refuse(const std::string& what, const std::string& cure) {
  throw std::invalid_argument{what + "; " + cure};
}

std::unique_ptr<Wheels> make_canopen(CanBus& bus, const WheelsSettings& settings) {
  if (!canopen::is_node(settings.left_id) || !canopen::is_node(settings.right_id)) {
    refuse("a CANopen node is out of its domain", "use 1 to 127");
  }
  const auto left = static_cast<std::uint8_t>(settings.left_id);
  const auto right = static_cast<std::uint8_t>(settings.right_id);
  CanopenWheelsConfig config =
      left == right ? dual_cia402_drive(left) : two_cia402_drives(left, right);
  config.wheels[0].counter.inverted = settings.left_inverted;
  config.wheels[1].counter.inverted = settings.right_inverted;
  config.produce_sync = settings.produce_sync;
  config.setup.enabled = settings.set_up_nodes;
  return std::make_unique<CanWheels<CanopenWheels>>(bus, config);
}

std::unique_ptr<Wheels> make_odrive(CanBus& bus, const WheelsSettings& settings) {
  OdriveWheelsConfig config;
  config.wheels[0] = {static_cast<std::uint8_t>(settings.left_id & 0xFFU), settings.left_inverted};
  config.wheels[1] = {static_cast<std::uint8_t>(settings.right_id & 0xFFU),
                      settings.right_inverted};
  constexpr std::uint32_t kMaxTurnsPerSecond = 200;
  constexpr std::uint32_t kMaxCounts = 0xFFFFFFFFU / kMaxTurnsPerSecond;
  if (settings.counts_per_turn > 0) { config.counts_per_turn = settings.counts_per_turn; }
  config.max_counts_per_s = std::min(config.counts_per_turn, kMaxCounts) * kMaxTurnsPerSecond;
  if (settings.left_id > kOdriveMaxNode || settings.right_id > kOdriveMaxNode || !config.valid()) {
    refuse("an ODrive setting is out of its domain",
           "use two different nodes from 0 to 63 and 1 to 20000000 counts a turn");
  }
  return std::make_unique<CanWheels<OdriveWheels>>(bus, config);
}

std::unique_ptr<Wheels> make_vesc(const WheelsSettings& settings) {
  VescWheelsConfig config;
  config.wheels[0] = {static_cast<std::uint8_t>(settings.left_id & 0xFFU), settings.left_inverted};
  config.wheels[1] = {static_cast<std::uint8_t>(settings.right_id & 0xFFU),
                      settings.right_inverted};
  config.pole_pairs = static_cast<std::uint16_t>(settings.pole_pairs & 0xFFFFU);
  if (settings.left_id > 255 || settings.right_id > 255 || !config.valid()) {
    refuse("a VESC setting is out of its domain",
           "use two different ids from 0 to 255 and the "
           "motor's pole pairs");
  }
  return std::make_unique<CanWheels<VescWheels>>(config);
}

std::unique_ptr<Wheels> make_dbc(const WheelsSettings& settings) {
  if (settings.dbc_file.empty()) { refuse("wheels 'dbc' need a DBC file", "set dbc_file"); }
  const DbcFile file = read_dbc(settings.dbc_file);
  DbcWheelsConfig config;
  config.wheels[0] = dbc_wheel(file, settings.left_signal);
  config.wheels[1] = dbc_wheel(file, settings.right_signal);
  config.wheels[0].counter.inverted = settings.left_inverted;
  config.wheels[1].counter.inverted = settings.right_inverted;
  for (std::size_t i = 0; i < 2; ++i) {
    if (settings.speed_ticks_per_unit > 0.0) {
      config.wheels[i].quantity = DbcQuantity::speed;
      config.wheels[i].ticks_per_unit = static_cast<float>(settings.speed_ticks_per_unit);
    } else if (settings.counts_per_turn > 0) {
      config.wheels[i].counter.modulus = settings.counts_per_turn;
    }
  }
  if (!config.valid()) {
    refuse(settings.dbc_file + ": the signals cannot be used as wheel positions",
           "positions are integers of at most 32 bits; for a speed set speed_ticks_per_unit");
  }
  return std::make_unique<CanWheels<DbcWheels>>(config);
}

}  // namespace

std::unique_ptr<Wheels> make_wheels(const std::string& name, CanBus& bus,
                                    const WheelsSettings& settings) {
  if (name == "canopen") { return make_canopen(bus, settings); }
  if (name == "odrive") { return make_odrive(bus, settings); }
  if (name == "vesc") { return make_vesc(settings); }
  if (name == "dbc") { return make_dbc(settings); }
  refuse("there are no wheels '" + name + "'", "use one of " + device_names(Kind::wheels));
}

}  // namespace picolo::inline v0::devices
