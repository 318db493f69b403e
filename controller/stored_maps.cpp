// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/stored_maps.hpp"

#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kPiecesPerStep = 16;  // 1 KiB a minor frame
constexpr int kTilesPerStep = 4;            // of the field: about 40 000 instructions

}  // namespace

Status StoredMaps::begin_save(std::uint8_t slot, LocaliserCore& localiser) {
  if (slot != 0) { return Status::invalid_argument; }
  job_ = Job::save;
  return store_.begin_save(localiser.map());
}

Status StoredMaps::begin_load(std::uint8_t slot, LocaliserCore& localiser) {
  if (slot != 0) { return Status::invalid_argument; }
  job_ = Job::load;
  return store_.begin_load(localiser.restorable_map());
}

Status StoredMaps::step(LocaliserCore& localiser) {
  if (job_ == Job::adopt) {
    return localiser.adopt_step(kTilesPerStep) ? Status::ok : Status::not_ready;
  }
  const Status status = store_.step(kPiecesPerStep);
  if (job_ == Job::save || status == Status::not_ready) { return status; }
  if (is_ok(status)) {
    job_ = Job::adopt;
    const Status begun = localiser.begin_adopting();
    return is_ok(begun) ? Status::not_ready : begun;
  }
  if (status == Status::io_error) { localiser.restorable_map().reset(0.0, 0.0); }
  return status;
}

}  // namespace picolo::inline v0
