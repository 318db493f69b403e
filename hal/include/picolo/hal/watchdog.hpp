// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What resets the board when the cycle stops.
#pragma once

namespace picolo::inline v0 {

/// Started by the port; must be stroked more often than the period that the port states. Context:
/// cycle only.
class Watchdog {
 public:
  virtual void stroke() = 0;

 protected:
  Watchdog() = default;
  Watchdog(const Watchdog&) = default;
  Watchdog& operator=(const Watchdog&) = default;
  ~Watchdog() = default;
};

}  // namespace picolo::inline v0
