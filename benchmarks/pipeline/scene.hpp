// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The scene of the pipeline benchmarks: a furnished room, its map, and a scan of 360 beams in it.
#pragma once

#include <memory>

#include "picolo/localisation/localiser.hpp"
#include "support/walls.hpp"

namespace picolo::bench {

struct Scene {
  std::unique_ptr<Localiser<SiteProfile>> localiser = std::make_unique<Localiser<SiteProfile>>();
  test::Scan scan = test::scan_at(test::furnished_room(), {0.1, 0.05, 0.02}, 360);

  Scene() {
    const test::Scan first = test::scan_at(test::furnished_room(), {}, 360);
    for (int i = 0; i < 5; ++i) {
      static_cast<void>(localiser->core().process(sweep_of(first, {}), true));
    }
  }

  [[nodiscard]] static UndistortedSweep sweep_of(const test::Scan& scan,
                                                 const Pose2d& odom_T_base) {
    UndistortedSweep sweep;
    sweep.odom_T_base = odom_T_base;
    sweep.points = scan.view();
    return sweep;
  }

  [[nodiscard]] const RollingMapCore& map() const { return localiser->core().map(); }
};

}  // namespace picolo::bench
