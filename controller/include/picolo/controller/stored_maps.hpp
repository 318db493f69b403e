// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The commands' maps in a byte store.
#pragma once

#include <cstdint>

#include "picolo/controller/map_store.hpp"
#include "picolo/controller/services.hpp"

namespace picolo::inline v0 {

/// Slot 0 is the one map that a MapStore keeps. A loaded map is localised in and not changed any
/// more; a stored one that is not whole leaves the
/// present one, a medium that fails half-way an empty one. Context: cycle only.
class StoredMaps final : public MapService {
 public:
  explicit StoredMaps(ByteStore& medium, const MapStoreConfig& config = {})
      : store_(medium, config) {}

  Status begin_save(std::uint8_t slot, LocaliserCore& localiser) override;
  Status begin_load(std::uint8_t slot, LocaliserCore& localiser) override;
  Status step(LocaliserCore& localiser) override;

 private:
  enum class Job : std::uint8_t { save, load, adopt };

  MapStore store_;
  Job job_ = Job::save;
};

}  // namespace picolo::inline v0
