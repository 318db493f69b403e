// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The watchdog of the Cortex-M System Design Kit: an NMI first, a reset one period later.
#pragma once

#include "picolo/core/time.hpp"
#include "picolo/hal/watchdog.hpp"

namespace picolo::inline v0::mps2 {

class CmsdkWatchdog final : public Watchdog {
 public:
  /// Precondition: period at most 171 s.
  void start(Duration period);
  void stroke() override;
};

}  // namespace picolo::inline v0::mps2
