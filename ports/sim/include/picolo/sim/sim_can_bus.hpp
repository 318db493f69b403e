// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A CAN bus with two ends: the firmware's is `CanBus`, the vehicle's delivers and takes frames.
#pragma once

#include <cstddef>
#include <cstdint>

#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/clock.hpp"
#include "picolo/sim/ring.hpp"

namespace picolo::inline v0::sim {

/// Hears every frame that passes the wire, e.g. to record it. Called from within deliver and
/// transmit.
class CanListener {
 public:
  /// `from_firmware`: sent by the end that the controller holds. `frame.stamp`: its end on the
  /// wire.
  virtual void heard(const CanFrame& frame, bool from_firmware) = 0;

 protected:
  CanListener() = default;
  CanListener(const CanListener&) = default;
  CanListener& operator=(const CanListener&) = default;
  ~CanListener() = default;
};

/// Time on the wire of a frame: 47 or 67 bits and its data, without stuff bits, rounded down to
/// microseconds.
[[nodiscard]] Duration frame_time(const CanFrame& frame, std::uint32_t bit_rate);

/// One wire: frames follow each other, none overlap; each is stamped with its end. The receive
/// queue holds 256 frames as a socket does; more are lost and counted. No heap.
class SimCanBus final : public CanBus {
 public:
  explicit SimCanBus(Clock& clock, std::uint32_t bit_rate = 500'000);

  Result<CanFrame> receive() override;
  Status transmit(const CanFrame& frame) override;
  [[nodiscard]] CanStatus status() const override;

  /// Vehicle side: sends `frame`, not before `frame.stamp`. Returns the instant at which the last
  /// bit has passed; `receive` hands the frame out from then on.
  Timestamp deliver(const CanFrame& frame);
  /// Vehicle side: the oldest frame of the firmware whose last bit has passed by `until`, else
  /// `not_ready`.
  Result<CanFrame> take_sent(Timestamp until);
  /// The fault confinement state that `status` shows. `bus_off` and `absent` lose what is
  /// delivered; `absent` answers every call with `disconnected`, `bus_off` refuses to send. Leaving
  /// `bus_off` counts a restart.
  void set_state(CanState state);
  /// At most one; nullptr detaches.
  void attach(CanListener* listener) { listener_ = listener; }

  static constexpr std::size_t kReceiveCapacity = 256;
  static constexpr std::size_t kTransmitCapacity = 64;

 private:
  Timestamp occupy(Timestamp earliest, const CanFrame& frame);

  Clock& clock_;
  std::uint32_t bit_rate_;
  Timestamp free_from_{};
  CanStatus status_{};
  CanListener* listener_ = nullptr;
  Ring<CanFrame, kReceiveCapacity> to_firmware_{};
  Ring<CanFrame, kTransmitCapacity> from_firmware_{};
};

}  // namespace picolo::inline v0::sim
