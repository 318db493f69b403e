// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "doctor/link_details.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <sys/socket.h>

#include <array>
#include <cstring>
#include <span>

#include "picolo/linux/file_descriptor.hpp"

namespace picolo::tool {
namespace {

using Bytes = std::span<const std::uint8_t>;

template <typename T>
std::optional<T> value_of(Bytes bytes) {
  if (bytes.size() < sizeof(T)) { return std::nullopt; }
  T value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  return value;
}

constexpr std::size_t aligned(std::size_t size) {
  return (size + 3) & ~std::size_t{3};
}

/// Payload of the attribute of that type, nested ones alike; empty when there is none.
Bytes attribute(Bytes bytes, unsigned type) {
  while (bytes.size() >= sizeof(rtattr)) {
    const rtattr head = *value_of<rtattr>(bytes);
    if (head.rta_len < sizeof(rtattr) || head.rta_len > bytes.size()) { break; }
    if ((head.rta_type & NLA_TYPE_MASK) == type) {
      return bytes.subspan(sizeof(rtattr), head.rta_len - sizeof(rtattr));
    }
    bytes = bytes.subspan(std::min(bytes.size(), aligned(head.rta_len)));
  }
  return {};
}

CanState to_state(std::uint32_t state) {
  switch (state) {
    case CAN_STATE_ERROR_WARNING: return CanState::warning;
    case CAN_STATE_ERROR_PASSIVE: return CanState::passive;
    case CAN_STATE_BUS_OFF: return CanState::bus_off;
    default: return CanState::active;
  }
}

LinkDetails parse(unsigned flags, Bytes attributes) {
  LinkDetails details;
  details.is_up = (flags & IFF_UP) != 0;
  const Bytes info = attribute(attributes, IFLA_LINKINFO);
  const Bytes kind = attribute(info, IFLA_INFO_KIND);
  for (const std::uint8_t c : kind) {
    if (c != 0) { details.kind.push_back(static_cast<char>(c)); }
  }
  const Bytes data = attribute(info, IFLA_INFO_DATA);
  if (details.kind != "can") { return details; }
  if (const auto timing = value_of<can_bittiming>(attribute(data, IFLA_CAN_BITTIMING))) {
    if (timing->bitrate > 0) { details.bit_rate = timing->bitrate; }
  }
  details.restart_ms = value_of<std::uint32_t>(attribute(data, IFLA_CAN_RESTART_MS));
  if (const auto state = value_of<std::uint32_t>(attribute(data, IFLA_CAN_STATE))) {
    details.state = to_state(*state);
  }
  return details;
}

}  // namespace

std::optional<LinkDetails> link_details(const std::string& name) {
  const unsigned index = ::if_nametoindex(name.c_str());
  if (index == 0) { return std::nullopt; }
  const FileDescriptor socket{::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE)};
  struct {
    nlmsghdr head;
    ifinfomsg link;
  } request{};
  request.head.nlmsg_len = sizeof request;
  request.head.nlmsg_type = RTM_GETLINK;
  request.head.nlmsg_flags = NLM_F_REQUEST;
  request.link.ifi_index = static_cast<int>(index);
  const timeval patience{.tv_sec = 1, .tv_usec = 0};
  static_cast<void>(
      ::setsockopt(socket.get(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience));
  if (::send(socket.get(), &request, sizeof request, 0) < 0) { return std::nullopt; }
  std::array<std::uint8_t, 16384> answer{};
  const ssize_t size = ::recv(socket.get(), answer.data(), answer.size(), 0);
  if (size < static_cast<ssize_t>(sizeof request)) { return std::nullopt; }
  const Bytes bytes{answer.data(), static_cast<std::size_t>(size)};
  if (value_of<nlmsghdr>(bytes)->nlmsg_type != RTM_NEWLINK) { return std::nullopt; }
  const ifinfomsg link = *value_of<ifinfomsg>(bytes.subspan(sizeof(nlmsghdr)));
  return parse(link.ifi_flags, bytes.subspan(sizeof request));
}

}  // namespace picolo::tool
