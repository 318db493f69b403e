// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/executive/checkpoints.hpp"

namespace picolo::inline v0 {

void CheckpointMonitor::begin(std::uint32_t expected) {
  expected_ = expected;
  passed_ = 0;
  next_key_ = 0;
  spoilt_ = false;
}

void CheckpointMonitor::pass(std::uint32_t key) {
  if (key < next_key_) {
    spoilt_ = true;
    return;
  }
  next_key_ = key + 1;
  ++passed_;
}

}  // namespace picolo::inline v0
