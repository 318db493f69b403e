// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/sim_byte_store.hpp"

#include <algorithm>

namespace picolo::inline v0::sim {

SimByteStore::SimByteStore(std::span<std::uint8_t> memory, std::size_t sector, std::size_t granule)
    : memory_(memory), sector_(sector), granule_(granule) {
  std::fill(memory_.begin(), memory_.end(), std::uint8_t{0xFF});
}

ByteStoreGeometry SimByteStore::geometry() const {
  return {.size = memory_.size(), .sector = sector_, .granule = granule_};
}

Status SimByteStore::read(std::size_t address, std::span<std::uint8_t> bytes) {
  if (!powered_) { return Status::io_error; }
  if (!inside(address, bytes.size())) { return Status::out_of_range; }
  const std::span<const std::uint8_t> source = memory_.subspan(address, bytes.size());
  std::copy(source.begin(), source.end(), bytes.begin());
  return Status::ok;
}

Status SimByteStore::program(std::size_t address, std::span<const std::uint8_t> bytes) {
  if (!powered_) { return Status::io_error; }
  if (!inside(address, bytes.size())) { return Status::out_of_range; }
  if (address % granule_ != 0 || bytes.size() % granule_ != 0) { return Status::invalid_argument; }
  for (std::size_t done = 0; done < bytes.size(); done += granule_) {
    const std::span<std::uint8_t> granule = memory_.subspan(address + done, granule_);
    const bool torn = power_fails_now();
    const auto erased = [](std::uint8_t byte) { return byte == 0xFF; };
    if (!std::all_of(granule.begin(), granule.end(), erased)) { ++overwrites_; }
    // Torn: not a bit, every bit, or some bits of the granule were written.
    const std::uint32_t fate = torn ? random_.below(4) : 1;
    for (std::size_t i = 0; i < granule_; ++i) {
      const std::uint32_t some = random_.next_u32() & 0xFFU;
      const std::uint32_t kept = fate == 0 ? 0xFFU : fate == 1 ? 0U : some;
      granule[i] = static_cast<std::uint8_t>(granule[i] & (bytes[done + i] | kept));
    }
    if (torn) { return Status::io_error; }
  }
  return Status::ok;
}

Status SimByteStore::erase(std::size_t address) {
  if (!powered_) { return Status::io_error; }
  if (!inside(address, sector_)) { return Status::out_of_range; }
  if (address % sector_ != 0) { return Status::invalid_argument; }
  const bool torn = power_fails_now();
  for (std::uint8_t& byte : memory_.subspan(address, sector_)) {
    const std::uint32_t fate = torn ? random_.below(3) : 1;
    if (fate == 1) { byte = 0xFF; }
    if (fate == 2) { byte = static_cast<std::uint8_t>(random_.next_u32() & 0xFFU); }
  }
  return torn ? Status::io_error : Status::ok;
}

void SimByteStore::cut_power_after(std::uint32_t operations, std::uint64_t seed) {
  armed_ = true;
  remaining_ = operations;
  random_ = Random{seed};
}

void SimByteStore::restore_power() {
  powered_ = true;
  armed_ = false;
}

bool SimByteStore::inside(std::size_t address, std::size_t size) const {
  return address <= memory_.size() && size <= memory_.size() - address;
}

bool SimByteStore::power_fails_now() {
  ++operations_;
  if (!armed_) { return false; }
  if (remaining_ == 0) {
    powered_ = false;
    return true;
  }
  --remaining_;
  return false;
}

}  // namespace picolo::inline v0::sim
