// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "counters.hpp"
#include "picolo/devices/registry.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"

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
  return std::make_unique<CanWheels<CanopenWheels>>(bus, config);
}

}  // namespace

std::unique_ptr<Wheels> make_wheels(const std::string& name, CanBus& bus,
                                    const WheelsSettings& settings) {
  if (name == "canopen") { return make_canopen(bus, settings); }
  refuse("there are no wheels '" + name + "'", "use one of " + device_names(Kind::wheels));
}

}  // namespace picolo::inline v0::devices
