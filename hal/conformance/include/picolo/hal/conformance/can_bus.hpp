// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every CanBus must do.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

#include "picolo/hal/can_bus.hpp"
#include "picolo/hal/conformance/checker.hpp"

namespace picolo::inline v0::conformance {

/// `inject`: another node sends a frame. `sent`: the oldest frame of the port that another node has
/// received and not yet returned, `not_ready` when there is none. `wait`: lets time pass. `now`:
/// the port's clock. Optional: `unplug_bus()` and `plug_bus()`, for a controller that can go away
/// and come back; `hold()` and `release()`, for an emulated wire that takes no time: frames stay in
/// the controller in between; `static constexpr std::uint8_t kRemoteLength`, for an emulated
/// controller that damages remote frames of other lengths.
template <typename H>
concept CanBusHarness = requires(H& harness, const CanFrame& frame, Duration duration) {
  { harness.bus() } -> std::convertible_to<CanBus&>;
  { harness.inject(frame) } -> std::convertible_to<bool>;
  { harness.sent() } -> std::same_as<Result<CanFrame>>;
  { harness.now() } -> std::same_as<Timestamp>;
  harness.wait(duration);
};

namespace detail {

[[nodiscard]] constexpr CanFrame numbered_frame(std::uint32_t number) {
  CanFrame frame{.id = 0x100 + number % 0x600, .length = static_cast<std::uint8_t>(number % 9)};
  for (std::size_t i = 0; i < frame.length; ++i) {
    frame.data[i] = static_cast<std::uint8_t>(number * 7 + i);
  }
  return frame;
}

/// Same on the wire: stamps do not count, nor do bytes beyond the length.
[[nodiscard]] constexpr bool same_on_wire(const CanFrame& a, const CanFrame& b) {
  if (a.id != b.id || a.extended != b.extended || a.remote != b.remote || a.length != b.length) {
    return false;
  }
  for (std::size_t i = 0; i < a.length && !a.remote; ++i) {
    if (a.data[i] != b.data[i]) { return false; }
  }
  return true;
}

template <CanBusHarness Harness>
void can_bus_receives(Harness& harness, Checker& checker, const CanFrame& frame,
                      const char* contract, const char* cure) {
  const bool injected = harness.inject(frame);
  harness.wait(10ms);
  const Result<CanFrame> received = harness.bus().receive();
  checker.expect(injected && received && same_on_wire(*received, frame), contract, cure);
}

template <typename Harness>
constexpr std::uint8_t remote_length() {
  if constexpr (requires { Harness::kRemoteLength; }) { return Harness::kRemoteLength; }
  return 4;
}

template <CanBusHarness Harness>
void can_bus_receives_all_kinds(Harness& harness, Checker& checker) {
  checker.expect(harness.bus().receive().status() == Status::not_ready,
                 "CanBus::receive answers not_ready while no frame waits",
                 "never block in receive, poll the FIFO's level");
  for (std::uint32_t length = 0; length <= 8; ++length) {
    can_bus_receives(
        harness, checker, numbered_frame(length),
        "CanBus::receive delivers standard frames of 0 to 8 bytes unchanged",
        "check the identifier's shift, the length code and the byte order of the data registers");
  }
  CanFrame extended = numbered_frame(8);
  extended.id = 0x1ABCDEF0;
  extended.extended = true;
  can_bus_receives(harness, checker, extended,
                   "CanBus::receive delivers 29-bit identifiers and says that they are",
                   "set CanFrame::extended from the IDE bit and open the acceptance filter for it");
  extended.id = 0x123;
  can_bus_receives(harness, checker, extended,
                   "CanBus::receive tells a 29-bit identifier below 0x800 from an 11-bit one",
                   "set CanFrame::extended from the IDE bit, not from the identifier's size");
  CanFrame remote{.id = 0x321, .remote = true, .length = remote_length<Harness>()};
  can_bus_receives(harness, checker, remote,
                   "CanBus::receive says which frames are remote requests",
                   "set CanFrame::remote from the RTR bit");
}

template <CanBusHarness Harness>
void can_bus_keeps_order_and_stamps(Harness& harness, Checker& checker) {
  constexpr std::uint32_t kFrames = 20;
  const std::uint32_t received_before = harness.bus().status().received;
  const Timestamp begin = harness.now();
  for (std::uint32_t i = 0; i < kFrames; ++i) {
    static_cast<void>(harness.inject(numbered_frame(i)));
  }
  harness.wait(20ms);
  Timestamp last = begin;
  std::uint32_t count = 0;
  bool in_order = true;
  bool stamps_rise = true;
  bool stamps_true = true;
  for (auto frame = harness.bus().receive(); frame && count < kFrames;
       frame = harness.bus().receive()) {
    in_order = in_order && same_on_wire(*frame, numbered_frame(count));
    stamps_rise = stamps_rise && frame->stamp >= last;
    stamps_true = stamps_true && frame->stamp >= begin && frame->stamp <= harness.now();
    last = frame->stamp;
    ++count;
  }
  checker.expect(count == kFrames, "CanBus holds at least 20 frames between two drains",
                 "enlarge the receive ring, and drain the hardware FIFO in its interrupt");
  checker.expect(in_order, "CanBus::receive delivers frames in the order of the wire",
                 "use a FIFO, not several mailboxes that are read by number");
  checker.expect(stamps_rise, "stamps never decrease from frame to frame",
                 "take the stamp once, where the frame is taken from the hardware");
  checker.expect(stamps_true,
                 "a frame's stamp is the instant of its arrival, on the port's own clock",
                 "map hardware or kernel stamps to Clock::now before handing them out");
  checker.expect(harness.bus().status().received - received_before == kFrames,
                 "CanStatus::received counts the frames handed out",
                 "count in receive, once a frame, and never reset");
}

template <CanBusHarness Harness>
void can_bus_transmits(Harness& harness, Checker& checker) {
  const std::uint32_t before = harness.bus().status().transmitted;
  CanFrame extended = numbered_frame(8);
  extended.id = 0x1ABCDEF0;
  extended.extended = true;
  const CanFrame frames[] = {numbered_frame(0), numbered_frame(5), numbered_frame(8), extended};
  std::uint32_t accepted = 0;
  for (const CanFrame& frame : frames) {
    const Status status = harness.bus().transmit(frame);
    harness.wait(10ms);
    accepted += is_ok(status) ? 1U : 0U;
    const Result<CanFrame> sent = harness.sent();
    checker.expect(
        is_ok(status) && sent && same_on_wire(*sent, frame),
        "CanBus::transmit puts the frame on the wire unchanged",
        "check identifier, IDE bit, length code and byte order of the transmit registers");
  }
  checker.expect(harness.bus().status().transmitted - before == accepted,
                 "CanStatus::transmitted counts the accepted frames",
                 "count in transmit, once a frame that was queued");
  checker.expect(harness.bus().receive().status() == Status::not_ready,
                 "CanBus::receive does not return own frames",
                 "switch self-reception (loop-back) off");
}

template <CanBusHarness Harness>
void can_bus_refuses_impossible_frames(Harness& harness, Checker& checker) {
  const CanFrame impossible[] = {
      {.id = 0x800}, {.id = 0x2000'0000, .extended = true}, {.id = 1, .length = 9}};
  for (const CanFrame& frame : impossible) {
    checker.expect(
        harness.bus().transmit(frame) == Status::invalid_argument,
        "CanBus::transmit answers invalid_argument to an identifier or length out of range",
        "test id <= 0x7FF (0x1FFFFFFF when extended) and length <= 8 first");
  }
  harness.wait(10ms);
  checker.expect(harness.sent().status() == Status::not_ready,
                 "an impossible frame never reaches the wire", "return before anything is queued");
}

/// No time passes and nobody listens while the queue is filled.
template <CanBusHarness Harness>
void can_bus_survives_a_full_queue(Harness& harness, Checker& checker) {
  const std::uint32_t refused_before = harness.bus().status().tx_refused;
  if constexpr (requires { harness.hold(); }) { harness.hold(); }
  Status status = Status::ok;
  for (int i = 0; i < 20'000 && is_ok(status); ++i) {
    status = harness.bus().transmit(numbered_frame(1));
  }
  checker.expect(status == Status::full,
                 "CanBus::transmit answers full when there is no room, and never blocks",
                 "bound the send queue; map ENOBUFS and EAGAIN to full");
  checker.expect(harness.bus().status().tx_refused > refused_before,
                 "CanStatus::tx_refused counts the frames that found no room", "count in transmit");
  if constexpr (requires { harness.release(); }) { harness.release(); }
  bool drained = false;
  for (int i = 0; i < 20'000 && !drained; ++i) {
    if (!harness.sent()) {
      harness.wait(10ms);
      drained = !harness.sent();
    }
  }
  checker.expect(
      is_ok(harness.bus().transmit(numbered_frame(2))),
      "CanBus::transmit works again when the queue has drained",
      "do not keep a full queue as an error state; clear the controller's request flags");
  harness.wait(10ms);
  static_cast<void>(harness.sent());
}

template <CanBusHarness Harness>
void can_bus_comes_back(Harness& harness, Checker& checker) {
  harness.unplug_bus();
  harness.wait(10ms);
  Status received = harness.bus().receive().status();
  for (int i = 0; i < 100 && received != Status::disconnected; ++i) {
    received = harness.bus().receive().status();
  }
  checker.expect(received == Status::disconnected,
                 "CanBus::receive answers disconnected while the controller is gone",
                 "map ENETDOWN, ENODEV and end of file to disconnected");
  checker.expect(harness.bus().transmit(numbered_frame(1)) == Status::disconnected,
                 "CanBus::transmit answers disconnected while the controller is gone",
                 "as for receive");
  checker.expect(harness.bus().status().state == CanState::absent,
                 "CanStatus::state is absent while the controller is gone",
                 "set it where disconnected is found out");
  harness.plug_bus();
  harness.wait(10ms);
  static_cast<void>(harness.bus().receive());
  can_bus_receives(harness, checker, numbered_frame(3),
                   "CanBus works again when the controller has come back",
                   "open it again from receive, in bounded time");
}

}  // namespace detail

/// Precondition: nothing waits in either direction. Takes about half a second of the port's time.
template <CanBusHarness Harness>
void check_can_bus(Harness& harness, Checker& checker) {
  detail::can_bus_receives_all_kinds(harness, checker);
  detail::can_bus_keeps_order_and_stamps(harness, checker);
  detail::can_bus_transmits(harness, checker);
  detail::can_bus_refuses_impossible_frames(harness, checker);
  detail::can_bus_survives_a_full_queue(harness, checker);
  if constexpr (requires {
                  harness.unplug_bus();
                  harness.plug_bus();
                }) {
    detail::can_bus_comes_back(harness, checker);
  }
}

}  // namespace picolo::inline v0::conformance
