// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/board/memory_byte_store.hpp"

#include <algorithm>
#include <array>

namespace picolo::inline v0::board {
namespace {

constexpr std::array<std::uint8_t, MemoryByteStore::kGranule> kMark{0x70, 0x69, 0x63, 0x6F,
                                                                    0x6C, 0x6F, 0x5A, 0xA5};

}  // namespace

MemoryByteStore::MemoryByteStore(std::span<std::uint8_t> memory, std::size_t sector)
    : store_(memory.first(memory.size() - sector)), sector_(sector) {
  const std::span<std::uint8_t> mark = memory.last(kMark.size());
  survived_ = std::equal(kMark.begin(), kMark.end(), mark.begin());
  if (survived_) { return; }
  std::fill(store_.begin(), store_.end(), std::uint8_t{0xFF});
  std::copy(kMark.begin(), kMark.end(), mark.begin());
}

ByteStoreGeometry MemoryByteStore::geometry() const {
  return {.size = store_.size(), .sector = sector_, .granule = kGranule};
}

Status MemoryByteStore::read(std::size_t address, std::span<std::uint8_t> bytes) {
  if (!inside(address, bytes.size())) { return Status::out_of_range; }
  std::copy_n(store_.begin() + static_cast<std::ptrdiff_t>(address), bytes.size(), bytes.begin());
  return Status::ok;
}

Status MemoryByteStore::program(std::size_t address, std::span<const std::uint8_t> bytes) {
  if (!inside(address, bytes.size())) { return Status::out_of_range; }
  if (address % kGranule != 0 || bytes.size() % kGranule != 0) { return Status::invalid_argument; }
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    store_[address + i] = static_cast<std::uint8_t>(store_[address + i] & bytes[i]);
  }
  return Status::ok;
}

Status MemoryByteStore::erase(std::size_t address) {
  if (!inside(address, sector_)) { return Status::out_of_range; }
  if (address % sector_ != 0) { return Status::invalid_argument; }
  std::fill_n(store_.begin() + static_cast<std::ptrdiff_t>(address), sector_, std::uint8_t{0xFF});
  return Status::ok;
}

bool MemoryByteStore::inside(std::size_t address, std::size_t size) const {
  return address <= store_.size() && size <= store_.size() - address;
}

}  // namespace picolo::inline v0::board
