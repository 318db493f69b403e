// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The controller in an image, fed one packet a minor frame, answers as its twin on this machine
// does: every published word and every CAN frame, bit for bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <sstream>

#include "lockstep_run.hpp"
#include "picolo/controller/controller_config.hpp"
#include "support/data.hpp"

namespace picolo::target {
namespace {

TEST(Lockstep, EveryReplyOfAnImageEqualsItsTwins) {
  PICOLO_NEED_IMAGES();
  std::cout << "| platform | frames | unequal | CAN frames sent | matches | error to truth |\n"
               "|---|---|---|---|---|---|\n";
  for (const Platform& platform : platforms_to_judge()) {
    if (platform.program.empty()) { continue; }
    const auto drive = simulated_drive(sim::SceneName::office, 10s);
    const LockstepRun run = run_lockstep(platform, *drive, false);
    EXPECT_EQ(run.trouble, "") << platform.name;
    EXPECT_EQ(run.unequal, 0U) << platform.name << ", first in frame " << run.first_unequal;
    EXPECT_GT(run.frames, 1990U);
    EXPECT_GT(run.matches, 80U);
    EXPECT_GT(run.pose_frames, 500U);
    EXPECT_LT(run.final_error_m, 0.05);
    std::cout << "| " << platform.name << " | " << run.frames << " | " << run.unequal << " | "
              << run.pose_frames << " | " << run.matches << " | " << run.final_error_m << " m |\n";
  }
}

}  // namespace
}  // namespace picolo::target
