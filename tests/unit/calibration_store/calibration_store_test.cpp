// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/controller/calibration_store.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <vector>

#include "picolo/core/bytes.hpp"
#include "picolo/core/crc.hpp"
#include "picolo/sim/sim_byte_store.hpp"

namespace picolo {
namespace {

constexpr std::size_t kSector = 256;

CalibrationRecord numbered(int k) {
  CalibrationRecord record;
  record.drive = {0.07 + k, 0.08 + k, 0.4 + k, {0.1 + k, 0.2 + k, 0.3 + k}};
  record.drive_std = {1e-4 * k, 2, 3, 4, 5, 6};
  record.time_offset_s = 0.01 * k;
  record.gyro_bias_radps = -0.001 * k;
  record.gyro_scale = 1.0 + 0.001 * k;
  record.gyro_offset_s = 0.04;
  record.calibrated = true;
  return record;
}

bool same(const CalibrationRecord& a, const CalibrationRecord& b) {
  std::array<std::uint8_t, kCalibrationRecordSize> x{};
  std::array<std::uint8_t, kCalibrationRecordSize> y{};
  encode_record(a, 1, x);
  encode_record(b, 1, y);
  return x == y && a.calibrated == b.calibrated;
}

Status save(CalibrationStore& store, const CalibrationRecord& record, std::size_t granules = 4) {
  const Status begun = store.begin_save(record);
  if (!is_ok(begun)) { return begun; }
  Status status = Status::not_ready;
  while (status == Status::not_ready) { status = store.step(granules); }
  return status;
}

struct Flash {
  explicit Flash(std::size_t granule) : memory(2 * kSector), device(memory, kSector, granule) {}
  std::vector<std::uint8_t> memory;
  sim::SimByteStore device;
};

TEST(CalibrationStore, BlankStorageGivesDefaultsAndSaysSo) {
  Flash flash{8};
  CalibrationStore store{flash.device};
  CalibrationRecord record = numbered(3);
  EXPECT_EQ(store.load(record), Status::not_ready);
  EXPECT_FALSE(record.calibrated);
  EXPECT_EQ(record.gyro_scale, 1.0);
}

TEST(CalibrationStore, KeepsTheLastOfManySavesAndNeverOverwritesAGranule) {
  for (const std::size_t granule : {1U, 4U, 8U}) {
    Flash flash{granule};
    for (int k = 1; k <= 20; ++k) {
      CalibrationStore store{flash.device};
      ASSERT_EQ(save(store, numbered(k)), Status::ok);
      CalibrationRecord record;
      ASSERT_EQ(CalibrationStore{flash.device}.load(record), Status::ok);
      EXPECT_TRUE(same(record, numbered(k)));
    }
    EXPECT_EQ(flash.device.overwrites(), 0U);
  }
}

/// Power fails in a save at operation `first`, and again in the save after the restart at operation
/// `second`.
int cut_cases(std::size_t granule, std::uint64_t seed, std::uint32_t step_second, int& wrong) {
  int cases = 0;
  const auto operations = static_cast<std::uint32_t>(1 + kCalibrationRecordSize / granule);
  for (std::uint32_t first = 0; first <= operations; ++first) {
    for (std::uint32_t second = 0; second <= operations; second += step_second) {
      Flash flash{granule};
      {
        CalibrationStore store{flash.device};
        if (!is_ok(save(store, numbered(1))) || !is_ok(save(store, numbered(2)))) { ++wrong; }
        flash.device.cut_power_after(first, seed + first);
        const Status ended = save(store, numbered(3));
        if (is_ok(ended) != (first == operations)) { ++wrong; }
      }
      flash.device.restore_power();
      CalibrationRecord after_first;
      CalibrationStore restarted{flash.device};
      if (!is_ok(restarted.load(after_first))) { ++wrong; }
      const bool old_or_new = same(after_first, numbered(2)) || same(after_first, numbered(3));
      if (!old_or_new || (first == operations && !same(after_first, numbered(3)))) { ++wrong; }
      ++cases;
      flash.device.cut_power_after(second, seed * 7 + second);
      static_cast<void>(save(restarted, numbered(4)));
      flash.device.restore_power();
      CalibrationRecord after_second;
      if (!is_ok(CalibrationStore{flash.device}.load(after_second))) { ++wrong; }
      if (!same(after_second, after_first) && !same(after_second, numbered(4))) { ++wrong; }
      ++cases;
    }
  }
  return cases;
}

TEST(CalibrationStore, AfterAPowerCutAnywhereTheRecordIsWhollyOldOrWhollyNew) {
  int wrong = 0;
  int cases = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) { cases += cut_cases(8, 1000 * seed, 1, wrong); }
  for (std::uint64_t seed = 1; seed <= 10; ++seed) { cases += cut_cases(4, 2000 * seed, 1, wrong); }
  for (std::uint64_t seed = 1; seed <= 2; ++seed) { cases += cut_cases(1, 3000 * seed, 1, wrong); }
  std::printf("%d power cuts, %d wrong states\n", cases, wrong);
  EXPECT_GT(cases, 100'000);
  EXPECT_EQ(wrong, 0);
}

TEST(CalibrationRecord, EveryFlippedBitAndEveryBurstUpTo32BitsIsSeen) {
  std::array<std::uint8_t, kCalibrationRecordSize> good{};
  encode_record(numbered(5), 77, good);
  constexpr std::size_t kBits =
      8 * (kCalibrationRecordSize - 4);  // the last four bytes are filling
  std::uint32_t checked = 0;
  for (std::size_t length = 1; length <= 32; ++length) {
    for (std::size_t begin = 0; begin + length <= kBits; ++begin) {
      for (const std::uint32_t inner : {0U, 0xFFFFFFFFU, 0xA5A5A5A5U}) {
        auto bad = good;
        for (std::size_t k = 0; k < length; ++k) {
          const bool flipped = k == 0 || k + 1 == length || ((inner >> k) & 1U) != 0;
          if (flipped) {
            const std::size_t bit = begin + k;
            bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1U << (bit % 8)));
          }
        }
        DecodedRecord decoded;
        ASSERT_NE(decode_record(bad, decoded), Status::ok)
            << "burst of " << length << " at bit " << begin;
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 100'000U);
}

/// What the stored CRC disagrees by when one bit is flipped: linear in the flips, since the CRC is.
std::uint32_t syndrome(std::size_t bit) {
  constexpr std::size_t kCovered = kCalibrationRecordSize - 8;
  std::array<std::uint8_t, kCovered> zero{};
  std::array<std::uint8_t, kCovered> one{};
  if (bit >= 8 * kCovered) { return 1U << (bit - 8 * kCovered); }
  one[bit / 8] = static_cast<std::uint8_t>(1U << (bit % 8));
  return crc32(one) ^ crc32(zero);
}

// No flips within 32 neighbouring bits cancel: their syndromes are independent in every window.
TEST(CalibrationRecord, EveryPatternOfEveryBurstUpTo32BitsIsSeen) {
  constexpr std::size_t kBits = 8 * (kCalibrationRecordSize - 4);
  std::vector<std::uint32_t> all(kBits);
  for (std::size_t bit = 0; bit < kBits; ++bit) { all[bit] = syndrome(bit); }
  for (std::size_t begin = 0; begin + 32 <= kBits; ++begin) {
    std::array<std::uint32_t, 32> basis{};  // by highest bit
    int rank = 0;
    for (std::size_t k = 0; k < 32; ++k) {
      std::uint32_t v = all[begin + k];
      for (std::size_t high = 32; high-- > 0 && v != 0;) {
        if (((v >> high) & 1U) == 0) { continue; }
        if (basis[high] == 0) {
          basis[high] = v;
          ++rank;
          v = 0;
        } else {
          v ^= basis[high];
        }
      }
    }
    ASSERT_EQ(rank, 32) << "window at bit " << begin;
  }
}

// The one burst that changes which bytes the CRC covers: version and length of version 1.
TEST(CalibrationRecord, ABurstThatMakesItLookOlderIsSeen) {
  std::array<std::uint8_t, kCalibrationRecordSize> bytes{};
  encode_record(numbered(5), 77, bytes);
  store_u16_le(bytes, 4, 1);
  store_u16_le(bytes, 6, 120);
  DecodedRecord decoded;
  EXPECT_EQ(decode_record(bytes, decoded), Status::corrupt);
}

/// Rewrites the version and the CRC, as another firmware would have written them.
void rewrite(std::span<std::uint8_t> bytes, std::uint16_t version, std::uint16_t payload) {
  store_u16_le(bytes, 4, version);
  store_u16_le(bytes, 6, payload);
  store_u32_le(bytes, 16U + payload, crc32(bytes.first(16U + payload)));
}

TEST(CalibrationStore, ANewerVersionIsRefusedAndNotErased) {
  Flash flash{8};
  CalibrationStore store{flash.device};
  ASSERT_EQ(save(store, numbered(1)), Status::ok);
  ASSERT_EQ(save(store, numbered(2)), Status::ok);
  rewrite(flash.device.memory().subspan(kSector, kCalibrationRecordSize), 3, 128);
  const std::vector<std::uint8_t> before{flash.device.memory().begin(),
                                         flash.device.memory().end()};
  CalibrationRecord record;
  EXPECT_EQ(store.load(record), Status::unsupported);
  EXPECT_FALSE(record.calibrated);
  EXPECT_EQ(store.begin_save(numbered(9)), Status::unsupported);
  EXPECT_TRUE(std::equal(before.begin(), before.end(), flash.device.memory().begin()));
}

TEST(CalibrationRecord, AnOlderVersionIsMigrated) {
  std::array<std::uint8_t, kCalibrationRecordSize> bytes{};
  encode_record(numbered(4), 9, bytes);
  rewrite(bytes, 1, 120);
  DecodedRecord decoded;
  ASSERT_EQ(decode_record(bytes, decoded), Status::ok);
  EXPECT_EQ(decoded.version, 1U);
  EXPECT_EQ(decoded.sequence, 9U);
  EXPECT_EQ(decoded.record.gyro_scale, numbered(4).gyro_scale);
  EXPECT_EQ(decoded.record.gyro_offset_s, 0.0);
  rewrite(bytes, 1, 64);
  EXPECT_EQ(decode_record(bytes, decoded), Status::corrupt) << "whole, but not what version 1 was";
}

TEST(CalibrationStore, SequenceNumbersWrap) {
  Flash flash{8};
  std::array<std::uint8_t, kCalibrationRecordSize> bytes{};
  encode_record(numbered(1), 0xFFFFFFFFU, bytes);
  ASSERT_EQ(flash.device.program(0, bytes), Status::ok);
  CalibrationStore store{flash.device};
  ASSERT_EQ(save(store, numbered(2)), Status::ok);
  CalibrationRecord record;
  ASSERT_EQ(store.load(record), Status::ok);
  EXPECT_TRUE(same(record, numbered(2)));
}

TEST(CalibrationStore, BothSlotsDamagedIsCorruptAndASaveHeals) {
  Flash flash{8};
  CalibrationStore store{flash.device};
  ASSERT_EQ(save(store, numbered(1)), Status::ok);
  flash.device.memory()[20] ^= 1U;
  CalibrationRecord record;
  EXPECT_EQ(store.load(record), Status::corrupt);
  EXPECT_EQ(save(store, numbered(2)), Status::ok);
  EXPECT_EQ(store.load(record), Status::ok);
  EXPECT_TRUE(same(record, numbered(2)));
}

TEST(CalibrationStore, RefusesAMediumThatIsTooSmallAndASecondSaveAtOnce) {
  std::vector<std::uint8_t> memory(256);
  sim::SimByteStore small{memory, 128, 8};
  CalibrationStore store{small};
  CalibrationRecord record;
  EXPECT_EQ(store.load(record), Status::invalid_argument);
  EXPECT_EQ(store.begin_save(record), Status::invalid_argument);
  Flash flash{8};
  CalibrationStore busy{flash.device};
  EXPECT_EQ(busy.step(1), Status::ok) << "nothing to do";
  ASSERT_EQ(busy.begin_save(numbered(1)), Status::ok);
  EXPECT_EQ(busy.begin_save(numbered(2)), Status::full);
  EXPECT_TRUE(busy.saving());
}

}  // namespace
}  // namespace picolo
