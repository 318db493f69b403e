// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/common/can_overlap.hpp"

namespace picolo::inline v0 {
namespace {

const CanFilter* common_filter(const CanListener& a, const CanListener& b) {
  for (const CanFilter& mine : a.filters) {
    for (const CanFilter& theirs : b.filters) {
      if (overlap(mine, theirs)) { return &mine; }
    }
  }
  return nullptr;
}

}  // namespace

Result<CanOverlap> find_overlap(std::span<const CanListener> listeners) {
  for (std::size_t i = 0; i < listeners.size(); ++i) {
    for (std::size_t k = i + 1; k < listeners.size(); ++k) {
      const CanFilter* filter = common_filter(listeners[i], listeners[k]);
      if (filter != nullptr) { return CanOverlap{listeners[i].name, listeners[k].name, *filter}; }
    }
  }
  return Status::not_ready;
}

}  // namespace picolo::inline v0
