// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The same cases run on a virtual interface and on two controllers that share a bus.
#pragma once

#include "can_bench.hpp"

namespace picolo::test {

inline Wiring vcan() {
  return {.name = "vcan",
          .port = "vcan0",
          .other = "vcan0",
          .remove = "/sbin/ip link del vcan0",
          .make = "/sbin/ip link add vcan0 type vcan && /sbin/ip link set vcan0 up"};
}

/// A controller goes as an adapter does that is pulled: its driver is unbound.
inline Wiring controllers() {
  return {.name = "sja1000",
          .port = "can0",
          .other = "can1",
          .remove =
              "basename $(readlink -f /sys/class/net/can0/device) > /tmp/can0.slot && "
              "cat /tmp/can0.slot > /sys/bus/pci/drivers/kvaser_pci/unbind",
          .make =
              "cat /tmp/can0.slot > /sys/bus/pci/drivers/kvaser_pci/bind && "
              "/sbin/ip link set can0 type can bitrate 500000 restart-ms 100 && "
              "/sbin/ip link set can0 up"};
}

}  // namespace picolo::test
