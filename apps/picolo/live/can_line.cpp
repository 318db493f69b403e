// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/can_line.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <sstream>
#include <system_error>
#include <utility>

#include "live/serial_line.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

using host::ExitCode;
using host::UserError;

constexpr Duration kLookPeriod = 200ms;
constexpr int kKind = SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC;

/// 0: no number.
std::uint32_t to_rate(const std::string& text) {
  std::uint32_t rate = 0;
  const char* end = text.data() + text.size();
  return std::from_chars(text.data(), end, rate).ptr == end ? rate : 0;
}

std::string errno_text() {
  return std::generic_category().message(errno);
}

sockaddr_un address_of(const std::string& path) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path.empty() || path.size() >= sizeof address.sun_path) {
    throw UserError{ExitCode::usage, "--can socket:" + path, "no path for a socket",
                    "give one of at most 100 characters"};
  }
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  return address;
}

const sockaddr* generic(const sockaddr_un& address) {
  const void* any = &address;
  return static_cast<const sockaddr*>(any);
}

}  // namespace

CanLine::CanLine(Clock& clock, std::string name, Role role)
    : clock_(clock), name_(std::move(name)), role_(role), bus_(clock) {}

bool CanLine::open(std::span<const CanFilter> filters) {
  if (name_.rfind("socket:", 0) == 0) {
    path_ = name_.substr(7);
    const sockaddr_un address = address_of(path_);
    if (role_ == Role::first) {
      listener_ = FileDescriptor{::socket(AF_UNIX, kKind, 0)};
      static_cast<void>(::unlink(path_.c_str()));
      if (::bind(listener_.get(), generic(address), sizeof address) != 0 ||
          ::listen(listener_.get(), 1) != 0) {
        throw UserError{ExitCode::device, path_, "cannot be made: " + errno_text(),
                        "give a path in a folder that you may write to"};
      }
    }
    look();
    return joined_;
  }
  if (name_.rfind("slcan:", 0) == 0) { return open_adapter(name_.substr(6)); }
  if (name_.rfind("fd:", 0) == 0) {
    int fd = -1;
    const char* end = name_.data() + name_.size();
    const auto parsed = std::from_chars(name_.data() + 3, end, fd);
    if (parsed.ptr != end || !is_ok(bus_.adopt(fd))) {
      throw UserError{ExitCode::usage, "--can " + name_, "no open socket has this number",
                      "hand one over when starting the program"};
    }
    return true;
  }
  const Status status = bus_.open(name_.c_str(), filters);
  if (status == Status::ok) { return true; }
  if (status == Status::disconnected) { return false; }
  if (status == Status::unsupported) {
    throw UserError{ExitCode::device, name_, "this kernel has no CAN",
                    "load it (modprobe can can-raw vcan), or use --can socket:PATH with "
                    "picolo simulate"};
  }
  throw UserError{status == Status::invalid_argument ? ExitCode::usage : ExitCode::device, name_,
                  status == Status::invalid_argument ? "no name of an interface"
                                                     : "cannot be opened: " + errno_text(),
                  "ip -details link shows the interfaces; picolo doctor --can looks closer"};
}

bool CanLine::open_adapter(const std::string& words) {
  std::istringstream text{words};
  std::string path;
  std::string bit_rate = "500000";
  std::string baud = "2000000";
  std::string rest;
  std::getline(text, path, ',');
  std::getline(text, bit_rate, ',');
  std::getline(text, baud, ',');
  const SlcanConfig config{.bit_rate = to_rate(bit_rate)};
  const TermiosConfig line{.baud = to_rate(baud)};
  if (path.empty() || std::getline(text, rest) || !config.valid() || !line.valid()) {
    throw UserError{ExitCode::usage, "--can " + name_, "is no serial adapter's name",
                    "give slcan:TTY[,BITRATE[,BAUD]]; bit rates are 10, 20, 50, 100, 125, 250, "
                    "500, 800 or 1000 times 1000"};
  }
  serial_.emplace(clock_, line);
  adapter_.emplace(*serial_, config);
  return open_line(*serial_, path, "can");
}

void CanLine::look() {
  const Timestamp now = clock_.now();
  if (now < next_look_) { return; }
  next_look_ = now + kLookPeriod;
  FileDescriptor socket;
  if (role_ == Role::first) {
    socket = FileDescriptor{::accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC)};
  } else {
    const sockaddr_un address = address_of(path_);
    socket = FileDescriptor{::socket(AF_UNIX, kKind, 0)};
    if (::connect(socket.get(), generic(address), sizeof address) != 0) { return; }
  }
  if (socket.is_open()) { joined_ = is_ok(bus_.adopt(socket.release())); }
}

Result<CanFrame> CanLine::receive() {
  if (adapter_) { return adapter_->receive(); }
  if (!path_.empty() && !joined_) {
    look();
    if (!joined_) { return Status::disconnected; }
  }
  const Result<CanFrame> frame = bus_.receive();
  if (!path_.empty() && frame.status() == Status::disconnected) { joined_ = false; }
  return frame;
}

}  // namespace picolo::tool
