// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counters of drivers by name.
#pragma once

#include "picolo/devices/registry.hpp"
#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/common/serial_counters.hpp"
#include "picolo/drivers/common/wheel_collector.hpp"
#include "picolo/drivers/ld06/ld06.hpp"
#include "picolo/drivers/witmotion/witmotion.hpp"

namespace picolo::inline v0::devices {

[[nodiscard]] Counters to_list(const SerialCounters& counters);
[[nodiscard]] Counters to_list(const Ld06Counters& counters);
[[nodiscard]] Counters to_list(const WitMotionCounters& counters);
[[nodiscard]] Counters to_list(const CanopenWheelsCounters& counters);
[[nodiscard]] Counters to_list(const CanWheelsCounters& counters);

}  // namespace picolo::inline v0::devices
