// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "live/can_line.hpp"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>
#include <utility>

#include "picolo/host/error.hpp"

namespace picolo::tool {
namespace {

using host::ExitCode;
using host::UserError;

constexpr Duration kLookPeriod = 200ms;
constexpr int kKind = SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC;

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
  if (!path_.empty() && !joined_) {
    look();
    if (!joined_) { return Status::disconnected; }
  }
  const Result<CanFrame> frame = bus_.receive();
  if (!path_.empty() && frame.status() == Status::disconnected) { joined_ = false; }
  return frame;
}

}  // namespace picolo::tool
