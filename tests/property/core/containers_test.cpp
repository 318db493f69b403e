// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The fixed containers behave like the standard ones as long as there is room, and refuse after
// that.

#include <deque>
#include <vector>

#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/ring_buffer.hpp"
#include "support/property.hpp"

namespace picolo {
namespace {

RC_GTEST_PROP(FixedVectorModel, BehavesLikeAVectorWithALimit, (const std::vector<int>& steps)) {
  constexpr std::size_t kCapacity = 8;
  FixedVector<int, kCapacity> items;
  std::vector<int> model;
  for (const int step : steps) {
    if (step % 7 == 0) {
      items.clear();
      model.clear();
    } else if (step % 5 == 0 && !model.empty()) {
      RC_ASSERT(items.resize(model.size() - 1));
      model.pop_back();
    } else {
      const bool room = model.size() < kCapacity;
      RC_ASSERT(items.push_back(step) == room);
      if (room) { model.push_back(step); }
    }
    RC_ASSERT(std::vector<int>(items.begin(), items.end()) == model);
    RC_ASSERT(items.full() == (model.size() == kCapacity));
    RC_ASSERT(items.empty() == model.empty());
  }
}

RC_GTEST_PROP(SpscRingModel, BehavesLikeAQueueWithALimit, (const std::vector<int>& steps)) {
  constexpr std::uint32_t kCapacity = 4;
  SpscRing<int, kCapacity> ring;
  std::deque<int> model;
  std::uint32_t dropped = 0;
  for (const int step : steps) {
    if (step % 3 == 0) {
      int value = 0;
      RC_ASSERT(ring.pop(value) == !model.empty());
      if (!model.empty()) {
        RC_ASSERT(value == model.front());
        model.pop_front();
      }
    } else {
      const bool room = model.size() < kCapacity;
      RC_ASSERT(ring.push(step) == room);
      if (room) {
        model.push_back(step);
      } else {
        ++dropped;
      }
    }
    RC_ASSERT(ring.size() == model.size());
    RC_ASSERT(ring.dropped() == dropped);
  }
}

RC_GTEST_PROP(LatestValueModel, ReadsWhatWasPublishedLast, (const std::vector<std::int64_t>& all)) {
  LatestValue<std::int64_t> latest;
  std::int64_t value = 0;
  RC_ASSERT(!latest.read(value));
  for (const std::int64_t published : all) {
    latest.publish(published);
    RC_ASSERT(latest.read(value));
    RC_ASSERT(value == published);
  }
  RC_ASSERT(latest.sequence() == all.size());
}

}  // namespace
}  // namespace picolo
