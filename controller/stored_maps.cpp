// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/stored_maps.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kPiecesPerStep = 16;  // 1 KiB a minor frame

}  // namespace

Status StoredMaps::begin_save(std::uint8_t slot, LocaliserCore& localiser) {
  if (slot != 0) { return Status::invalid_argument; }
  loading_ = false;
  return store_.begin_save(localiser.map());
}

Status StoredMaps::begin_load(std::uint8_t slot, LocaliserCore& localiser) {
  if (slot != 0) { return Status::invalid_argument; }
  loading_ = true;
  return store_.begin_load(localiser.restorable_map());
}

Status StoredMaps::step(LocaliserCore& localiser) {
  const Status status = store_.step(kPiecesPerStep);
  if (!loading_ || status == Status::not_ready) { return status; }
  if (is_ok(status)) { return localiser.localise_in_restored_map(); }
  localiser.restorable_map().reset(0.0, 0.0);
  return status;
}

}  // namespace picolo::inline v0
