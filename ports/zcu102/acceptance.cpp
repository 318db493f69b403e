// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/zcu102/acceptance.hpp"

#include <bit>

namespace picolo::inline v0::zcu102 {
namespace {

constexpr std::size_t kMostWanted = 32;

struct Pair {
  std::size_t first = 0;
  std::size_t second = 0;
};

/// The two of one kind whose covering filter keeps the most bits. With more than four filters there
/// are two of one kind.
Pair nearest(std::span<const CanFilter> filters) {
  Pair best;
  int best_bits = -1;
  for (std::size_t i = 0; i < filters.size(); ++i) {
    for (std::size_t k = i + 1; k < filters.size(); ++k) {
      if (filters[i].extended != filters[k].extended) { continue; }
      const int bits = std::popcount(covering(filters[i], filters[k]).mask);
      if (bits > best_bits) {
        best = {i, k};
        best_bits = bits;
      }
    }
  }
  return best;
}

}  // namespace

CanFilter covering(const CanFilter& a, const CanFilter& b) {
  const std::uint32_t mask = a.mask & b.mask & ~(a.id ^ b.id);
  return {.id = a.id & mask, .mask = mask, .extended = a.extended};
}

Status merge_filters(std::span<const CanFilter> wanted, HardwareFilters& merged) {
  FixedVector<CanFilter, kMostWanted> left;
  for (const CanFilter& filter : wanted) {
    if (!left.push_back(filter)) { return Status::out_of_range; }
  }
  while (left.size() > kHardwareFilters) {
    const Pair pair = nearest(left.view());
    left[pair.first] = covering(left[pair.first], left[pair.second]);
    left[pair.second] = left[left.size() - 1];
    static_cast<void>(left.resize(left.size() - 1));
  }
  merged.clear();
  for (const CanFilter& filter : left.view()) { static_cast<void>(merged.push_back(filter)); }
  return Status::ok;
}

}  // namespace picolo::inline v0::zcu102
