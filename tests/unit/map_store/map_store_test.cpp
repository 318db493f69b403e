// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/map_store.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "picolo/controller/calibration_store.hpp"
#include "picolo/core/random.hpp"
#include "picolo/sim/sim_byte_store.hpp"
#include "support/slow_flash.hpp"

namespace picolo {
namespace {

constexpr std::size_t kSector = 512;
constexpr std::size_t kSectorsPerSlot = 3;
using Map = RollingMap<32, 32>;

/// A map that tells its number by its cells and its window.
std::unique_ptr<Map> numbered(int k) {
  auto map = std::make_unique<Map>();
  map->core().place(16 * k, -16 * k);
  Random random{static_cast<std::uint64_t>(k)};
  for (int i = 0; i < 60; ++i) {
    const auto value = static_cast<std::int8_t>(static_cast<int>(random.next_u32() % 150) - 50);
    const auto column = static_cast<int>(random.next_u32() % 32);
    map->core().restore(column, static_cast<int>(random.next_u32() % 32), {&value, 1});
  }
  return map;
}

bool same(const Map& a, const Map& b) {
  return a.core().window() == b.core().window() &&
         std::ranges::equal(a.core().occupancy(), b.core().occupancy());
}

Status finish(MapStore& store, Status begun, std::size_t pieces = 3) {
  if (!is_ok(begun)) { return begun; }
  Status status = Status::not_ready;
  while (status == Status::not_ready) { status = store.step(pieces); }
  return status;
}
Status save(MapStore& store, const Map& map) {
  return finish(store, store.begin_save(map.core()));
}
Status load(ByteStore& device, Map& map) {
  MapStore store{device};
  return finish(store, store.begin_load(map.core()));
}

struct Flash {
  explicit Flash(std::size_t granule)
      : memory(2 * kSectorsPerSlot * kSector), device(memory, kSector, granule) {}
  std::vector<std::uint8_t> memory;
  sim::SimByteStore device;
};

TEST(MapStore, BlankStorageSaysSo) {
  Flash flash{8};
  Map map;
  EXPECT_EQ(load(flash.device, map), Status::not_ready);
}

TEST(MapStore, KeepsTheLastOfManySavesAndNeverOverwritesAGranule) {
  for (const std::size_t granule : {1U, 8U, 16U}) {
    Flash flash{granule};
    for (int k = 1; k <= 7; ++k) {
      MapStore store{flash.device};
      ASSERT_EQ(save(store, *numbered(k)), Status::ok);
      EXPECT_EQ(store.header().sequence, static_cast<std::uint32_t>(k));
      Map back;
      ASSERT_EQ(load(flash.device, back), Status::ok);
      EXPECT_TRUE(same(back, *numbered(k)));
    }
    EXPECT_EQ(flash.device.overwrites(), 0U);
  }
}

TEST(MapStore, AfterAPowerCutAnywhereTheMapIsWhollyOldOrWhollyNew) {
  const auto first = numbered(1);
  const auto second = numbered(2);
  std::uint32_t operations = 0;
  {
    Flash flash{8};
    MapStore store{flash.device};
    ASSERT_EQ(save(store, *first), Status::ok);
    const std::uint32_t before = flash.device.operations();
    ASSERT_EQ(save(store, *second), Status::ok);
    operations = flash.device.operations() - before;
  }
  int cases = 0;
  for (std::uint64_t seed = 1; seed <= 450; ++seed) {
    for (std::uint32_t cut = 0; cut <= operations; ++cut) {
      Flash flash{8};
      {
        MapStore store{flash.device};
        ASSERT_EQ(save(store, *first), Status::ok);
        flash.device.cut_power_after(cut, 1000 * seed + cut);
        ASSERT_EQ(is_ok(save(store, *second)), cut == operations);
      }
      flash.device.restore_power();
      Map back;
      ASSERT_EQ(load(flash.device, back), Status::ok) << "cut " << cut << " seed " << seed;
      const bool is_new = same(back, *second);
      ASSERT_TRUE(is_new || same(back, *first)) << "cut " << cut << " seed " << seed;
      ASSERT_TRUE(is_new || cut < operations);
      ++cases;
    }
  }
  std::printf("%d power cuts, all old or new\n", cases);
  EXPECT_GT(cases, 20'000);
}

TEST(MapStore, DamageSinceTheSaveFallsBackToTheMapBefore) {
  Flash flash{4};
  MapStore store{flash.device};
  ASSERT_EQ(save(store, *numbered(1)), Status::ok);
  ASSERT_EQ(save(store, *numbered(2)), Status::ok);
  flash.device.memory()[kSectorsPerSlot * kSector + kMapHeaderSize + 20] ^= 0x10U;
  Map back;
  ASSERT_EQ(load(flash.device, back), Status::ok);
  EXPECT_TRUE(same(back, *numbered(1)));
  flash.device.memory()[kMapHeaderSize + 20] ^= 0x10U;
  EXPECT_EQ(load(flash.device, back), Status::corrupt);
  EXPECT_TRUE(same(back, *numbered(1))) << "untouched";
}

TEST(MapStore, TooSmallASlotIsFullAndTheOldMapStays) {
  Flash flash{8};
  MapStore store{flash.device};
  ASSERT_EQ(save(store, *numbered(1)), Status::ok);
  const auto large = std::make_unique<RollingMap<64, 64>>();
  Random random{3};
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) {
      const auto value = static_cast<std::int8_t>(random.next_u32() % 100);
      large->core().restore(column, row, {&value, 1});
    }
  }
  EXPECT_EQ(finish(store, store.begin_save(large->core())), Status::full);
  Map back;
  ASSERT_EQ(load(flash.device, back), Status::ok);
  EXPECT_TRUE(same(back, *numbered(1)));
}

TEST(MapStore, AWindowThatMovesDuringASaveEndsIt) {
  Flash flash{8};
  MapStore store{flash.device};
  const auto map = numbered(1);
  ASSERT_EQ(store.begin_save(map->core()), Status::ok);
  EXPECT_EQ(store.begin_save(map->core()), Status::full) << "one at a time";
  for (std::size_t k = 0; k <= kSectorsPerSlot; ++k) {
    ASSERT_EQ(store.step(1), Status::not_ready);
  }
  map->core().place(0, 0);
  EXPECT_EQ(store.step(1), Status::out_of_range);
  EXPECT_FALSE(store.busy());
}

TEST(MapStore, ErasesNoMoreThanItWrites) {
  Flash flash{8};
  test::SlowFlash device{flash.device, 0};
  MapStore store{device};
  ASSERT_EQ(save(store, *numbered(1)), Status::ok);
  const std::size_t used = kMapHeaderSize + store.header().payload_bytes + MapStore::kPieceSize;
  ASSERT_LT(used, 2 * kSector);
  EXPECT_LE(device.erases, used / kSector + 1);
}

// One flash, one erase at a time, and neither store knows of the other.
TEST(MapStore, SharesAFlashThatErasesInTheBackgroundWithACalibration) {
  for (int askings = 1; askings <= 9; ++askings) {
    std::vector<std::uint8_t> memory((2 + 2 * kSectorsPerSlot) * kSector);
    sim::SimByteStore flash{memory, kSector, 8};
    test::SlowFlash device{flash, askings};
    CalibrationStore records{device};
    MapStore maps{device, {.address = 2 * kSector}};
    for (int k = 1; k <= 4; ++k) {
      const auto map = numbered(k);
      CalibrationRecord record;
      record.gyro_scale = 1.0F + static_cast<float>(k);
      ASSERT_EQ(maps.begin_save(map->core()), Status::ok);
      Status status = maps.step(1);
      ASSERT_EQ(records.begin_save(record), Status::ok);
      for (int step = 0; records.saving() || maps.busy(); ++step) {
        ASSERT_LT(step, 1000);
        if (records.saving()) {
          const Status saved = records.step(1);
          ASSERT_TRUE(saved == Status::ok || saved == Status::not_ready);
        }
        if (maps.busy()) { status = maps.step(3); }
      }
      EXPECT_EQ(status, Status::ok);
      CalibrationRecord kept;
      ASSERT_EQ(records.load(kept), Status::ok);
      EXPECT_EQ(kept.gyro_scale, record.gyro_scale);
      Map back;
      MapStore reader{device, {.address = 2 * kSector}};
      ASSERT_EQ(finish(reader, reader.begin_load(back.core())), Status::ok);
      EXPECT_TRUE(same(back, *map));
    }
    EXPECT_GT(device.waits, device.erases * static_cast<std::uint32_t>(askings) - 1);
    EXPECT_EQ(flash.overwrites(), 0U);
  }
}

TEST(MapStore, SlotsThatDoNotFitAreRefused) {
  Flash flash{8};
  Map map;
  MapStore odd{flash.device, {.address = 8}};
  EXPECT_EQ(odd.begin_save(map.core()), Status::invalid_argument);
  MapStore beyond{flash.device, {.slot_size = 4 * kSector}};
  EXPECT_EQ(beyond.begin_load(map.core()), Status::invalid_argument);
}

}  // namespace
}  // namespace picolo
