// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Every device that picolo speaks to, by name: what `picolo run`, `picolo doctor` and a
/// configuration file choose from. Firmware names its drivers as types instead.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "picolo/core/result.hpp"
#include "picolo/core/time.hpp"
#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/can_filter.hpp"
#include "picolo/hal/serial_port.hpp"
#include "picolo/sensing/imu_sample.hpp"
#include "picolo/sensing/range_return.hpp"
#include "picolo/sensing/wheel_ticks.hpp"

namespace picolo::inline v0::devices {

enum class Kind : std::uint8_t { wheels, lidar, imu };

struct DeviceInfo {
  Kind kind;
  std::string name;                  ///< as in configuration files
  std::string title;                 ///< what people call it
  std::vector<std::uint32_t> bauds;  ///< to be tried in this order; empty on CAN
  bool has_gyro = false;             ///< of an IMU
  bool dtr = true;                   ///< level of the DTR line that its adapter needs
  bool on_request = false;           ///< silent until it is asked
};

[[nodiscard]] const std::vector<DeviceInfo>& all_devices();
/// Null when there is none of this name.
[[nodiscard]] const DeviceInfo* find_device(Kind kind, const std::string& name);
/// "ld06, rplidar, ..." for messages and help.
[[nodiscard]] std::string device_names(Kind kind);

struct Counter {
  std::string name;
  std::uint64_t value = 0;
};
using Counters = std::vector<Counter>;
/// 0 where a device does not count that.
[[nodiscard]] std::uint64_t value_of(const Counters& counters, std::string_view name);

/// A lidar behind its driver; satisfies LidarDevice.
class Lidar {
 public:
  virtual ~Lidar() = default;
  virtual Result<std::size_t> poll(std::size_t max_bytes, std::span<RangeReading> readings) = 0;
  /// Start-up, motor, restarts. Call every cycle.
  virtual Status service(Timestamp now) = 0;
  /// Motor off. Call again while it answers `not_ready`.
  virtual Status stop() = 0;
  [[nodiscard]] virtual Counters counters() const = 0;
  /// Why nothing comes, with its cure; empty when all is well or unknown.
  [[nodiscard]] virtual std::string trouble() const = 0;
};

/// An IMU behind its driver; satisfies ImuDevice.
class Imu {
 public:
  virtual ~Imu() = default;
  virtual Result<std::size_t> poll(std::size_t max_bytes, std::span<ImuSample> samples) = 0;
  virtual Status service(Timestamp now) = 0;
  virtual Status stop() = 0;
  [[nodiscard]] virtual Counters counters() const = 0;
  /// What is wrong with its axes, with the cure; empty when all is well or unknown.
  [[nodiscard]] virtual std::string trouble() const = 0;
};

/// Encoders behind their driver; satisfies WheelDevice.
class Wheels {
 public:
  virtual ~Wheels() = default;
  virtual bool consume(const CanFrame& frame) = 0;
  virtual Result<WheelTicks> take() = 0;
  virtual Status service(Timestamp now) = 0;
  /// The identifiers it listens to.
  [[nodiscard]] virtual std::vector<CanFilter> filters() const = 0;
  [[nodiscard]] virtual Counters counters() const = 0;
};

/// What does not apply to a device is ignored; 0 and empty = the device's own default.
struct LidarSettings {
  std::string mode{};  ///< rplidar: standard, express, ultra, dense; ydlidar: x4, tmini, scl
  std::uint32_t samples_per_second = 0;
  std::uint16_t motor_pwm = 0;  ///< rplidar A2, A3
  std::uint16_t motor_rpm = 0;  ///< rplidar S, C
};

struct ImuSettings {
  std::uint32_t rate_full_scale_degps = 0;
  std::uint32_t acceleration_full_scale_g = 0;
};

struct WheelsSettings {
  std::uint32_t left_id = 1;   ///< CANopen node, ODrive node or VESC id
  std::uint32_t right_id = 2;  ///< the same as left_id: one dual drive (CANopen)
  bool left_inverted = false;
  bool right_inverted = false;
  bool produce_sync = false;     ///< CANopen: nobody else sends SYNC
  bool set_up_nodes = false;     ///< CANopen: write mapping and transmission type to the nodes
  std::uint32_t pole_pairs = 7;  ///< VESC
  /// ODrive: ticks that a turn is made of. DBC: where a position wraps, when not at its bits.
  std::uint32_t counts_per_turn = 0;
  std::string dbc_file{};  ///< dbc: the file, and MESSAGE.SIGNAL of each wheel
  std::string left_signal{};
  std::string right_signal{};
  double speed_ticks_per_unit = 0.0;  ///< dbc: above 0, the signals are speeds in their own unit
};

/// Everything referred to outlives the driver. Throws std::invalid_argument with the cause and the
/// cure in words.
[[nodiscard]] std::unique_ptr<Lidar> make_lidar(const std::string& name, SerialPort& port,
                                                const LidarSettings& settings = {});
[[nodiscard]] std::unique_ptr<Imu> make_imu(const std::string& name, SerialPort& port,
                                            const ImuSettings& settings = {});
[[nodiscard]] std::unique_ptr<Wheels> make_wheels(const std::string& name, CanBus& bus,
                                                  const WheelsSettings& settings = {});

/// Two consumers of one bus that want the same identifier, in words; empty when there are none.
struct BusUser {
  std::string name;
  std::vector<CanFilter> filters;
};
[[nodiscard]] std::string describe_overlap(const std::vector<BusUser>& users);

}  // namespace picolo::inline v0::devices
