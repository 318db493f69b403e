// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What service data can read and change in a simulated node (CiA 301): heartbeat time, TPDO1 and
/// its mapping. Every other object does not exist.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "picolo/core/time.hpp"
#include "picolo/hal/can_bus.hpp"

namespace picolo::inline v0::sim {

/// 0x6064 and 0x606C of CiA 402 as entries of a mapping: index, subindex, bits.
inline constexpr std::uint32_t kMappedPosition = 0x6064'0020;
inline constexpr std::uint32_t kMappedVelocity = 0x606C'0020;

class CanopenObjects {
 public:
  CanopenObjects(std::uint8_t node, Duration heartbeat_period, std::uint8_t syncs_per_pdo,
                 bool with_velocity);

  /// The answer to a request of a client: expedited transfers, or an abort with its code.
  [[nodiscard]] CanFrame serve(const CanFrame& request);

  [[nodiscard]] Duration heartbeat_period() const { return heartbeat_period_; }
  [[nodiscard]] bool pdo_is_on() const { return (pdo_id_ & kOff) == 0; }
  [[nodiscard]] std::uint8_t syncs_per_pdo() const { return syncs_per_pdo_; }
  [[nodiscard]] std::span<const std::uint32_t> mapped() const { return {mapping_.data(), mapped_}; }

 private:
  static constexpr std::uint32_t kOff = 1U << 31;
  std::uint32_t write(std::uint32_t object, std::uint32_t value);
  std::uint32_t write_count(std::uint32_t count);
  [[nodiscard]] bool read(std::uint32_t object, std::uint32_t& value) const;

  std::uint8_t node_;
  Duration heartbeat_period_;
  std::uint32_t pdo_id_;
  std::uint8_t syncs_per_pdo_;
  std::array<std::uint32_t, 2> mapping_{kMappedPosition, kMappedVelocity};
  std::size_t mapped_;
};

}  // namespace picolo::inline v0::sim
