// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Power fails at every place where it makes a difference, and leaves what flash would leave.

#include "picolo/sim/sim_byte_store.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

namespace picolo::sim {
namespace {

class SimByteStoreTest : public ::testing::Test {
 protected:
  std::array<std::uint8_t, 512> memory{};
  SimByteStore store{memory, 128, 4};
  std::array<std::uint8_t, 32> pattern = [] {
    std::array<std::uint8_t, 32> bytes{};
    for (std::size_t i = 0; i < bytes.size(); ++i) { bytes[i] = static_cast<std::uint8_t>(i * 9); }
    return bytes;
  }();
};

TEST_F(SimByteStoreTest, GivenACutAtEveryGranuleThenBeforeIsNewTornIsBetweenAndAfterIsOld) {
  for (std::uint32_t cut = 0; cut < 8; ++cut) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      SimByteStore fresh{memory, 128, 4};
      fresh.cut_power_after(cut, seed);
      ASSERT_EQ(fresh.program(64, pattern), Status::io_error);
      EXPECT_FALSE(fresh.powered());
      for (std::size_t i = 0; i < pattern.size(); ++i) {
        const std::uint8_t now = memory[64 + i];
        const std::size_t granule = i / 4;
        if (granule < cut) { ASSERT_EQ(now, pattern[i]); }
        if (granule == cut) {
          ASSERT_EQ(now & pattern[i], pattern[i]) << "a bit too many is cleared";
        }
        if (granule > cut) { ASSERT_EQ(now, 0xFF); }
      }
    }
  }
}

TEST_F(SimByteStoreTest, GivenManySeedsThenTornGranulesDiffer) {
  bool old_seen = false;
  bool mixed_seen = false;
  bool new_seen = false;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    SimByteStore fresh{memory, 128, 4};
    fresh.cut_power_after(0, seed);
    ASSERT_EQ(fresh.program(0, std::array<std::uint8_t, 4>{}), Status::io_error);
    old_seen = old_seen || memory[0] == 0xFF;
    new_seen = new_seen || memory[0] == 0x00;
    mixed_seen = mixed_seen || (memory[0] != 0xFF && memory[0] != 0x00);
  }
  EXPECT_TRUE(old_seen);
  EXPECT_TRUE(new_seen);
  EXPECT_TRUE(mixed_seen);
}

TEST_F(SimByteStoreTest, GivenACutDuringEraseThenOnlyThatSectorIsUndefined) {
  ASSERT_EQ(store.program(96, pattern), Status::ok);   // up to the border
  ASSERT_EQ(store.program(128, pattern), Status::ok);  // behind it
  store.cut_power_after(0, 5);
  ASSERT_EQ(store.erase(128), Status::io_error);
  for (std::size_t i = 0; i < pattern.size(); ++i) { ASSERT_EQ(memory[96 + i], pattern[i]); }
  std::size_t kept = 0;
  std::size_t erased = 0;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    kept += memory[128 + i] == pattern[i] ? 1U : 0U;
    erased += memory[128 + i] == 0xFF ? 1U : 0U;
  }
  EXPECT_GT(kept, 3U);
  EXPECT_GT(erased, 3U);
  EXPECT_LT(kept + erased, pattern.size()) << "some bytes must be rubbish";
}

TEST_F(SimByteStoreTest, GivenNoPowerThenEveryCallFailsAndNothingChanges) {
  store.cut_power_after(0, 1);
  ASSERT_EQ(store.erase(0), Status::io_error);
  const auto before = memory;
  std::array<std::uint8_t, 4> bytes{};
  EXPECT_EQ(store.read(0, bytes), Status::io_error);
  EXPECT_EQ(store.program(0, bytes), Status::io_error);
  EXPECT_EQ(store.erase(128), Status::io_error);
  EXPECT_EQ(memory, before);
  store.restore_power();
  EXPECT_EQ(store.erase(0), Status::ok);
  EXPECT_EQ(store.program(0, bytes), Status::ok);
}

TEST_F(SimByteStoreTest, GivenOperationsThenTheyAreCountedByGranuleAndSector) {
  ASSERT_EQ(store.program(0, pattern), Status::ok);
  EXPECT_EQ(store.operations(), 8U);
  ASSERT_EQ(store.erase(0), Status::ok);
  EXPECT_EQ(store.operations(), 9U);
  EXPECT_EQ(store.overwrites(), 0U);
}

TEST_F(SimByteStoreTest, GivenAGranuleProgrammedTwiceThenItIsCounted) {
  ASSERT_EQ(store.program(0, pattern), Status::ok);
  ASSERT_EQ(store.program(0, std::span{pattern}.first(8)), Status::ok);
  EXPECT_EQ(store.overwrites(), 2U);
}

}  // namespace
}  // namespace picolo::sim
