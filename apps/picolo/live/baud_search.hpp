// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Finds the rate of a serial line by what its driver can make of the bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "picolo/core/time.hpp"
#include "picolo/devices/registry.hpp"

namespace picolo::tool {

/// A rate is right when three packets are sound, and more sound than damaged; then the search is
/// over for good. A rate that shows nothing for two seconds makes room for the next, round and
/// round.
class BaudSearch {
 public:
  /// `bauds`: the line has the first of them. One alone is not doubted.
  explicit BaudSearch(std::vector<std::uint32_t> bauds) : bauds_(std::move(bauds)) {}

  /// Call now and then with the counters of the driver; the rate to try next, if it is time to.
  /// `present`: there is a line at all.
  [[nodiscard]] std::optional<std::uint32_t> update(Timestamp now, bool present,
                                                    const devices::Counters& counters);
  [[nodiscard]] std::uint32_t baud() const { return bauds_[at_]; }
  /// Over, and not at the first rate: worth telling, once.
  [[nodiscard]] bool found_another();

 private:
  struct Tally {
    std::uint64_t sound = 0;
    std::uint64_t damaged = 0;
  };

  std::vector<std::uint32_t> bauds_;
  std::size_t at_ = 0;
  Tally before_{};  ///< when this rate was set
  std::uint64_t last_sound_ = 0;
  std::optional<Timestamp> patience_from_;
  bool over_ = false;
  bool told_ = false;
};

}  // namespace picolo::tool
