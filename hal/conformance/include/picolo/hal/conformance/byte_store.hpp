// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What every ByteStore must do.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "picolo/hal/byte_store.hpp"
#include "picolo/hal/conformance/checker.hpp"

namespace picolo::inline v0::conformance {

/// The store's contents are destroyed. Optional: `reopen()`, as after a reset of the board.
template <typename H>
concept ByteStoreHarness = requires(H& harness) {
  { harness.store() } -> std::convertible_to<ByteStore&>;
};

namespace detail {

inline constexpr std::size_t kMaxGranule = 16;

[[nodiscard]] inline bool store_holds(ByteStore& store, std::size_t address, std::size_t size,
                                      std::uint8_t value) {
  std::array<std::uint8_t, 64> bytes{};
  for (std::size_t done = 0; done < size;) {
    const std::size_t part = size - done < bytes.size() ? size - done : bytes.size();
    if (!is_ok(store.read(address + done, std::span{bytes}.first(part)))) { return false; }
    for (std::size_t i = 0; i < part; ++i) {
      if (bytes[i] != value) { return false; }
    }
    done += part;
  }
  return true;
}

/// A sector that erases in the background is asked for until it is done.
[[nodiscard]] inline Status erase_to_the_end(ByteStore& store, std::size_t address) {
  constexpr std::uint32_t kPatience = 10'000'000;
  Status status = Status::not_ready;
  for (std::uint32_t i = 0; i < kPatience && status == Status::not_ready; ++i) {
    status = store.erase(address);
  }
  return status;
}

template <ByteStoreHarness Harness>
bool byte_store_has_geometry(Harness& harness, Checker& checker) {
  const ByteStoreGeometry g = harness.store().geometry();
  const bool granule =
      g.granule == 1 || g.granule == 2 || g.granule == 4 || g.granule == 8 || g.granule == 16;
  return checker.expect(granule, "the granule is 1, 2, 4, 8 or 16 bytes",
                        "round up to the flash controller's word") &&
         checker.expect(g.sector > 0 && g.sector % g.granule == 0,
                        "a sector is a multiple of the granule",
                        "return the erase size of the flash") &&
         checker.expect(g.size >= 2 * g.sector && g.size % g.sector == 0,
                        "the store has at least two sectors, all of one size",
                        "leave sectors of another size out of the store");
}

template <ByteStoreHarness Harness>
void byte_store_erases_and_programs(Harness& harness, Checker& checker) {
  ByteStore& store = harness.store();
  const ByteStoreGeometry g = store.geometry();
  checker.expect(is_ok(erase_to_the_end(store, 0)) && is_ok(erase_to_the_end(store, g.sector)),
                 "ByteStore::erase answers ok to the start of a sector",
                 "unlock the flash controller, erase one sector, wait for its end");
  checker.expect(is_ok(store.read(0, std::span<std::uint8_t>{})),
                 "ByteStore::read answers ok to an address inside of the store",
                 "copy from the flash's address in memory");
  checker.expect(store_holds(store, 0, 2 * g.sector, 0xFF),
                 "ByteStore::erase leaves bytes that read 0xFF",
                 "wait for the erase to end; invalidate the cache");

  std::array<std::uint8_t, 2 * kMaxGranule> pattern{};
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    pattern[i] = static_cast<std::uint8_t>(0xA5 ^ i);
  }
  const std::span<const std::uint8_t> two = std::span{pattern}.first(2 * g.granule);
  // Over the border of two sectors.
  const bool programmed = is_ok(store.program(g.sector - g.granule, two));
  std::array<std::uint8_t, 2 * kMaxGranule> back{};
  const bool got = is_ok(store.read(g.sector - g.granule, std::span{back}.first(two.size())));
  bool same = programmed && got;
  for (std::size_t i = 0; i < two.size(); ++i) { same = same && back[i] == two[i]; }
  checker.expect(programmed, "ByteStore::program answers ok to whole granules of erased bytes",
                 "unlock the flash controller, write word by word, wait for its end");
  checker.expect(same, "read returns what was programmed, over the border of sectors too",
                 "split a write that crosses a page");
  checker.expect(store_holds(store, 0, g.sector - g.granule, 0xFF),
                 "program changes only the bytes that it was given",
                 "write whole granules, never whole pages");

  checker.expect(is_ok(erase_to_the_end(store, 0)) && store_holds(store, 0, g.sector, 0xFF),
                 "erase clears its sector to the last byte", "check the erase size");
  back.fill(0);
  const bool kept =
      is_ok(store.read(g.sector, std::span{back}.first(g.granule))) && back[0] == two[g.granule];
  checker.expect(kept, "erase leaves the neighbouring sector alone", "check the erase size");
}

template <ByteStoreHarness Harness>
void byte_store_never_sets_bits(Harness& harness, Checker& checker) {
  ByteStore& store = harness.store();
  const ByteStoreGeometry g = store.geometry();
  std::array<std::uint8_t, kMaxGranule> first{};
  std::array<std::uint8_t, kMaxGranule> second{};
  std::array<std::uint8_t, kMaxGranule> back{};
  first.fill(0x0F);
  second.fill(0xF1);
  static_cast<void>(erase_to_the_end(store, 0));
  static_cast<void>(store.program(0, std::span{first}.first(g.granule)));
  static_cast<void>(store.program(0, std::span{second}.first(g.granule)));
  static_cast<void>(store.read(0, std::span{back}.first(g.granule)));
  bool cleared_only = true;
  for (std::size_t i = 0; i < g.granule; ++i) {
    cleared_only = cleared_only && (back[i] & ~first[i]) == 0;
  }
  checker.expect(cleared_only, "programming a granule again never sets a bit",
                 "keep the old bits in an emulation: old AND new");
}

template <ByteStoreHarness Harness>
void byte_store_refuses_nonsense(Harness& harness, Checker& checker) {
  ByteStore& store = harness.store();
  const ByteStoreGeometry g = store.geometry();
  std::array<std::uint8_t, 2 * kMaxGranule> bytes{};
  const std::span<std::uint8_t> one = std::span{bytes}.first(g.granule);
  constexpr std::size_t kHuge = std::numeric_limits<std::size_t>::max() - 3;
  const char* cure = "compare without overflow: size <= capacity - address";
  checker.expect(store.read(g.size, one) == Status::out_of_range,
                 "read beyond the end answers out_of_range", cure);
  checker.expect(store.read(g.size - 1, std::span{bytes}.first(2)) == Status::out_of_range,
                 "read across the end answers out_of_range", cure);
  checker.expect(store.read(kHuge, std::span{bytes}.first(8)) == Status::out_of_range,
                 "an address that overflows answers out_of_range", cure);
  checker.expect(store.program(g.size, one) == Status::out_of_range,
                 "program beyond the end answers out_of_range", cure);
  checker.expect(store.erase(g.size) == Status::out_of_range,
                 "erase beyond the end answers out_of_range", cure);
  checker.expect(store.erase(1) == Status::invalid_argument,
                 "erase inside of a sector answers invalid_argument",
                 "take the start of a sector only");
  if (g.granule > 1) {
    checker.expect(store.program(1, one) == Status::invalid_argument,
                   "program off the granules answers invalid_argument",
                   "test address and size modulo the granule");
    checker.expect(store.program(0, one.first(1)) == Status::invalid_argument,
                   "program of part of a granule answers invalid_argument",
                   "test address and size modulo the granule");
  }
  checker.expect(is_ok(store.read(g.size - 1, one.first(1))), "the last byte can be read", cure);
  checker.expect(is_ok(store.program(0, {})) && is_ok(store.read(0, {})), "nothing to do is done",
                 "an empty span is fine");
}

template <ByteStoreHarness Harness>
void byte_store_remembers(Harness& harness, Checker& checker) {
  const ByteStoreGeometry g = harness.store().geometry();
  std::array<std::uint8_t, kMaxGranule> pattern{};
  pattern.fill(0x3C);
  static_cast<void>(erase_to_the_end(harness.store(), 0));
  static_cast<void>(harness.store().program(0, std::span{pattern}.first(g.granule)));
  harness.reopen();
  checker.expect(store_holds(harness.store(), 0, g.granule, 0x3C) &&
                     store_holds(harness.store(), g.granule, g.sector - g.granule, 0xFF),
                 "contents survive a reset", "do not erase or initialise a store that exists");
}

}  // namespace detail

/// Uses the first two sectors; erases each at most five times.
template <ByteStoreHarness Harness>
void check_byte_store(Harness& harness, Checker& checker) {
  if (!detail::byte_store_has_geometry(harness, checker)) { return; }
  detail::byte_store_erases_and_programs(harness, checker);
  detail::byte_store_never_sets_bits(harness, checker);
  detail::byte_store_refuses_nonsense(harness, checker);
  if constexpr (requires { harness.reopen(); }) { detail::byte_store_remembers(harness, checker); }
}

}  // namespace picolo::inline v0::conformance
