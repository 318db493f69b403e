// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <vector>

#include "doctor/link_details.hpp"
#include "doctor/probe.hpp"
#include "live/can_line.hpp"
#include "picolo/drivers/canopen/cob_id.hpp"
#include "picolo/host/error.hpp"
#include "picolo/linux/file_descriptor.hpp"
#include "picolo/linux/linux_clock.hpp"

namespace picolo::tool {
namespace {

constexpr int kArphrdCan = 280;
constexpr auto kListen = std::chrono::milliseconds{1200};

FileDescriptor open_socket(const std::string& path, CanFacts& facts) {
  FileDescriptor socket{::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0)};
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(),
              std::min(path.size() + 1, sizeof address.sun_path - 1));
  const void* any = &address;
  facts.is_virtual = true;
  facts.exists = ::connect(socket.get(), static_cast<const sockaddr*>(any), sizeof address) == 0;
  return socket;
}

FileDescriptor open_interface(const std::string& name, CanFacts& facts) {
  FileDescriptor socket{::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)};
  if (!socket.is_open()) {
    facts.kernel_has_can = errno != EAFNOSUPPORT && errno != EPROTONOSUPPORT;
    facts.may_open = !facts.kernel_has_can;
    return socket;
  }
  const auto details = link_details(name);
  facts.exists = details.has_value();
  if (!facts.exists) { return socket; }
  int type = 0;
  std::ifstream{"/sys/class/net/" + name + "/type"} >> type;
  facts.is_can = type == kArphrdCan || details->kind == "can" || details->kind == "vcan";
  facts.is_up = details->is_up;
  facts.is_virtual = details->kind == "vcan" || details->kind == "vxcan";
  facts.bit_rate = details->bit_rate;
  facts.restart_ms = details->restart_ms;
  facts.state = details->state;
  const can_err_mask_t errors = CAN_ERR_MASK;
  static_cast<void>(
      ::setsockopt(socket.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(::if_nametoindex(name.c_str()));
  const void* any = &address;
  if (facts.is_can &&
      ::bind(socket.get(), static_cast<const sockaddr*>(any), sizeof address) != 0) {
    facts.may_open = false;
  }
  return socket;
}

/// Each node is asked for its type: whoever lives answers, be it with "no such object".
CanFrame question_to(int node) {
  return {.id = 0x600 + static_cast<std::uint32_t>(node), .length = 8, .data = {0x40, 0x00, 0x10}};
}

void ask_nodes(int fd, CanFacts& facts) {
  for (const int node : facts.wanted_nodes) {
    const CanFrame question = question_to(node);
    can_frame request{};
    request.can_id = question.id;
    request.can_dlc = question.length;
    std::copy(question.data.begin(), question.data.end(), request.data);
    facts.sent = facts.sent && ::send(fd, &request, sizeof request, MSG_DONTWAIT | MSG_NOSIGNAL) ==
                                   static_cast<ssize_t>(sizeof request);
  }
}

void note_error(const can_frame& frame, CanFacts& facts) {
  if ((frame.can_id & CAN_ERR_ACK) != 0) { ++facts.not_acknowledged; }
  if ((frame.can_id & (CAN_ERR_PROT | CAN_ERR_BUSERROR)) != 0) { ++facts.protocol_errors; }
  if ((frame.can_id & CAN_ERR_BUSOFF) != 0) { facts.state = CanState::bus_off; }
  if ((frame.can_id & CAN_ERR_CRTL) == 0) { return; }
  const unsigned controller = frame.data[1];
  if ((controller & (CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_TX_OVERFLOW)) != 0) {
    ++facts.overflows;
  }
}

void note_frame(const CanFrame& frame, std::uint32_t own_id, CanFacts& facts) {
  ++facts.frames;
  if (frame.extended || frame.remote) { return; }
  if (frame.id >= own_id && frame.id < own_id + 16) { ++facts.foreign_talkers; }
  const auto node = static_cast<int>(frame.id & 0x7F);
  if (node == 0) { return; }
  const std::uint32_t kind = frame.id & 0x780;
  const bool is_sign_of_life = kind == 0x180 || kind == 0x580 || kind == 0x080;
  if (kind == 0x700) {
    facts.heard_nodes[node] = frame.length > 0 ? frame.data[0] & 0x7F : -1;
  } else if (is_sign_of_life) {
    facts.heard_nodes.try_emplace(node, -1);
  }
}

CanFrame to_frame(const can_frame& raw) {
  CanFrame frame{.id = raw.can_id & CAN_EFF_MASK, .length = raw.can_dlc};
  frame.extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  std::copy_n(raw.data, frame.data.size(), frame.data.begin());
  frame.stamp = LinuxClock{}.now();
  return frame;
}

/// The driver of the wheels, listening along: it and the controller cannot disagree.
class WheelsListener {
 public:
  explicit WheelsListener(const VehicleSettings& settings)
      : wheels_(devices::make_wheels(settings.wheels_name, bus_, settings.wheels)),
        filters_(wheels_->filters()),
        heard_(filters_.size()) {}

  void note(const CanFrame& frame) {
    for (std::size_t i = 0; i < filters_.size(); ++i) {
      heard_[i] = heard_[i] || filters_[i].accepts(frame.id, frame.extended);
    }
    static_cast<void>(wheels_->consume(frame));
    samples_ += wheels_->take() ? 1U : 0U;
  }
  void tell(CanFacts& facts) const {
    facts.samples = samples_;
    for (std::size_t i = 0; i < filters_.size(); ++i) {
      if (heard_[i]) { continue; }
      facts.missing_frames += fmt::format("{}0x{:0{}X}", facts.missing_frames.empty() ? "" : ", ",
                                          filters_[i].id, filters_[i].extended ? 8 : 3);
    }
  }
  [[nodiscard]] const std::vector<CanFilter>& filters() const { return filters_; }

 private:
  /// It only listens.
  class SilentBus final : public CanBus {
   public:
    Result<CanFrame> receive() override { return Status::not_ready; }
    Status transmit(const CanFrame& /*frame*/) override { return Status::ok; }
    [[nodiscard]] CanStatus status() const override { return {}; }
  };
  SilentBus bus_;
  std::unique_ptr<devices::Wheels> wheels_;
  std::vector<CanFilter> filters_;
  std::vector<bool> heard_;
  std::uint32_t samples_ = 0;
};

WheelsListener make_listener(const VehicleSettings& settings) {
  try {
    return WheelsListener{settings};
  } catch (const std::invalid_argument& error) {
    throw host::UserError{host::ExitCode::usage, "[wheels]", error.what(), "see picolo run --help"};
  }
}

void listen(int fd, std::uint32_t own_id, WheelsListener& wheels, CanFacts& facts) {
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + kListen;
  for (auto now = Clock::now(); now < end; now = Clock::now()) {
    pollfd wait{.fd = fd, .events = POLLIN, .revents = 0};
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - now).count();
    if (::poll(&wait, 1, static_cast<int>(left) + 1) <= 0) { continue; }
    can_frame frame{};
    const ssize_t size = ::recv(fd, &frame, sizeof frame, MSG_DONTWAIT);
    if (size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR)) {
      facts.is_up = facts.is_up && size != 0 && errno != ENETDOWN;
      return;
    }
    if (size != static_cast<ssize_t>(sizeof frame)) { continue; }
    if ((frame.can_id & CAN_ERR_FLAG) != 0) {
      note_error(frame, facts);
    } else {
      const CanFrame heard = to_frame(frame);
      note_frame(heard, own_id, facts);
      wheels.note(heard);
    }
  }
}

/// The same through a serial adapter.
void probe_adapter(const std::string& name, std::uint32_t own_id, WheelsListener& wheels,
                   CanFacts& facts) {
  LinuxClock clock;
  CanLine line{clock, name, CanLine::Role::second};
  facts.is_adapter = true;
  facts.is_virtual = true;
  facts.exists = line.open();
  if (!facts.exists) { return; }
  for (const int node : facts.wanted_nodes) {
    facts.sent = facts.sent && is_ok(line.transmit(question_to(node)));
  }
  for (const Timestamp end = clock.now() + Duration{kListen}; clock.now() < end;) {
    while (const Result<CanFrame> frame = line.receive()) {
      note_frame(*frame, own_id, facts);
      wheels.note(*frame);
    }
    static_cast<void>(sleep_until(clock.now() + Duration{2'000}));
  }
  const SlcanCounters heard = line.adapter_counters();
  facts.answers = facts.frames > 0 || heard.answers > 0 || heard.refused > 0;
}

}  // namespace

CanFacts probe_can(const std::string& name, const VehicleSettings& settings) {
  CanFacts facts;
  facts.name = name;
  WheelsListener wheels = make_listener(settings);
  facts.overlap = overlap_of(settings, wheels.filters());
  if (settings.wheels_name != "canopen") { facts.wheels = settings.wheels_name; }
  for (const std::uint32_t id : {settings.wheels.left_id, settings.wheels.right_id}) {
    const auto node = static_cast<int>(id);
    if (settings.wheels_name != "canopen") { break; }  // others cannot be asked alike
    if (std::find(facts.wanted_nodes.begin(), facts.wanted_nodes.end(), node) ==
        facts.wanted_nodes.end()) {
      facts.wanted_nodes.push_back(node);
    }
  }
  const std::uint32_t own_id = settings.controller.frames_out.base_id;
  if (name.rfind("slcan:", 0) == 0) {
    probe_adapter(name, own_id, wheels, facts);
    wheels.tell(facts);
    return facts;
  }
  const bool is_socket = name.rfind("socket:", 0) == 0;
  const FileDescriptor socket =
      is_socket ? open_socket(name.substr(7), facts) : open_interface(name, facts);
  if (!facts.kernel_has_can || !facts.exists || !facts.may_open || !facts.is_can || !facts.is_up) {
    return facts;
  }
  ask_nodes(socket.get(), facts);
  listen(socket.get(), own_id, wheels, facts);
  wheels.tell(facts);
  return facts;
}

}  // namespace picolo::tool
