// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The cycle never touches the heap. Links the trap that takes the place of malloc and free.

#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "picolo/heap_trap/heap_trap.hpp"
#include "picolo/simulated/simulated_controller.hpp"

namespace picolo {
namespace {

TEST(Heap, GivenADriveThenTheCycleNeverTouchesIt) {
  const sim::SimulationConfig simulation{.scene = sim::make_scene(sim::SceneName::office)};
  const auto robot = std::make_unique<SimulatedController<RoomProfile>>(simulation);
  ASSERT_EQ(robot->start(), Status::ok);
  const std::uint64_t before = heap_trap::calls();
  {
    const heap_trap::Guard guard;
    for (int frame = 0; frame < 200 * 20; ++frame) {
      if (robot->run_frame() != Status::ok) { break; }
    }
  }
  EXPECT_EQ(heap_trap::calls() - before, 0U);
  EXPECT_GT(robot->controller().estimate().matches, 180U);
}

TEST(Heap, TheTrapFires) {
  const std::uint64_t before = heap_trap::calls();
  {
    const heap_trap::Guard guard;
    auto block = std::make_unique<std::vector<int>>(100);
    ASSERT_EQ(block->size(), 100U);
  }
  EXPECT_GE(heap_trap::calls() - before, 4U);
}

}  // namespace
}  // namespace picolo
