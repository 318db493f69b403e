// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/map/map_codec.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "picolo/core/crc.hpp"
#include "picolo/core/random.hpp"

namespace picolo {
namespace {

constexpr int kSize = 64;
using Map = RollingMap<kSize, kSize>;

/// Walls, free and unknown space, and `noise` cells of any value.
std::unique_ptr<Map> drawn_map(int noise, std::uint64_t seed = 7) {
  auto map = std::make_unique<Map>();
  RollingMapCore& core = map->core();
  core.place(-48, 16);
  const std::vector<std::int8_t> wall(40, std::int8_t{100});
  const std::vector<std::int8_t> floor(50, std::int8_t{-60});
  for (int row = 5; row < 40; ++row) { core.restore(3, row, floor); }
  core.restore(10, 20, wall);
  Random random{seed};
  for (int k = 0; k < noise; ++k) {
    const auto column = static_cast<int>(random.next_u32() % kSize);
    const auto row = static_cast<int>(random.next_u32() % kSize);
    const auto value = static_cast<std::int8_t>(static_cast<int>(random.next_u32() % 160) - 60);
    core.restore(column, row, {&value, 1});
  }
  core.mark_all_stale();
  core.repair(core.stale_tiles());
  return map;
}

std::vector<std::uint8_t> encoded(const RollingMapCore& map, std::size_t piece) {
  MapEncoder encoder;
  encoder.begin(map);
  std::vector<std::uint8_t> all;
  std::vector<std::uint8_t> some(piece);
  for (std::size_t n = encoder.encode(some); n > 0; n = encoder.encode(some)) {
    all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(n));
  }
  return all;
}

MapHeader header_of(const RollingMapCore& map) {
  MapHeader header;
  header.window = map.window();
  header.occupied_from = map.config().occupied_from;
  return header;
}

bool equal(const RollingMapCore& a, const RollingMapCore& b) {
  return a.window() == b.window() && std::ranges::equal(a.occupancy(), b.occupancy());
}

class MapCodecNoise : public ::testing::TestWithParam<int> {};

TEST_P(MapCodecNoise, RoundTripsInPiecesOfAnySize) {
  const auto map = drawn_map(GetParam());
  const std::vector<std::uint8_t> whole = encoded(map->core(), 100'000);
  EXPECT_LE(whole.size(), std::size_t{kSize} * kSize * 129 / 128 + 1);
  for (const std::size_t piece : {1U, 2U, 3U, 7U, 64U}) {
    EXPECT_EQ(encoded(map->core(), piece), whole) << piece;
    const auto back = std::make_unique<Map>();
    MapDecoder decoder;
    ASSERT_EQ(decoder.begin(header_of(map->core()), back->core()), Status::ok);
    for (std::size_t at = 0; at < whole.size(); at += piece) {
      ASSERT_EQ(decoder.decode(ByteView{whole}.subspan(at, std::min(piece, whole.size() - at))),
                Status::ok);
    }
    EXPECT_TRUE(decoder.complete());
    EXPECT_TRUE(equal(map->core(), back->core()));
  }
}
INSTANTIATE_TEST_SUITE_P(Cells, MapCodecNoise, ::testing::Values(0, 50, 20'000));

TEST(MapCodec, TheFieldOfARestoredMapIsThatOfTheOriginal) {
  const auto map = drawn_map(300);
  const auto back = std::make_unique<Map>();
  MapDecoder decoder;
  ASSERT_EQ(decoder.begin(header_of(map->core()), back->core()), Status::ok);
  ASSERT_EQ(decoder.decode(encoded(map->core(), 64)), Status::ok);
  back->core().mark_all_stale();
  back->core().repair(back->core().stale_tiles());
  const std::size_t cells = std::size_t{kSize} * kSize;
  EXPECT_TRUE(std::equal(map->core().field().cells, map->core().field().cells + cells,
                         back->core().field().cells));
}

TEST(MapCodec, FreeSpaceIsShortAndASmallWindowGetsTheMiddle) {
  const auto map = drawn_map(0);
  const std::vector<std::uint8_t> bytes = encoded(map->core(), 64);
  EXPECT_LT(bytes.size(), 400U) << "of 4096 cells";
  const auto small = std::make_unique<RollingMap<32, 32>>();
  MapDecoder decoder;
  ASSERT_EQ(decoder.begin(header_of(map->core()), small->core()), Status::ok);
  ASSERT_EQ(decoder.decode(bytes), Status::ok);
  const GridWindow& window = small->core().window();
  EXPECT_EQ(window.origin_x_cells, -48 + 16);
  EXPECT_EQ(window.origin_y_cells, 16 + 16);
  for (int row = 0; row < 32; ++row) {
    for (int column = 0; column < 32; ++column) {
      EXPECT_EQ(
          small->core().occupancy()[static_cast<std::size_t>(row * 32 + column)],
          map->core().occupancy()[static_cast<std::size_t>((row + 16) * kSize + column + 16)]);
    }
  }
}

TEST(MapCodec, OtherCellsAreRefused) {
  const auto map = drawn_map(0);
  MapHeader header = header_of(map->core());
  header.window.cell_m = 0.08F;
  MapDecoder decoder;
  EXPECT_EQ(decoder.begin(header, map->core()), Status::invalid_argument);
  header = header_of(map->core());
  header.occupied_from = 1;
  EXPECT_EQ(decoder.begin(header, map->core()), Status::invalid_argument);
}

TEST(MapCodec, NoBytesWriteOutsideOfTheMap) {
  Random random{11};
  const auto map = drawn_map(0);
  const MapHeader header = header_of(map->core());
  int refused = 0;
  for (int k = 0; k < 400; ++k) {
    MapDecoder decoder;
    ASSERT_EQ(decoder.begin(header, map->core()), Status::ok);
    std::vector<std::uint8_t> bytes(random.next_u32() % 300);
    for (std::uint8_t& b : bytes) { b = static_cast<std::uint8_t>(random.next_u32()); }
    const Status status = decoder.decode(bytes);
    if (status != Status::ok) {
      EXPECT_EQ(status, Status::corrupt);
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(MapHeader, RoundTripsAndEveryFlippedBitIsSeen) {
  MapHeader header;
  header.sequence = 0xFFFFFFFE;
  header.window = {640, 480, 0.05F, -12'345, 678};
  header.occupied_from = 15;
  header.payload_bytes = 1000;
  header.payload_crc = 0xDEADBEEF;
  std::array<std::uint8_t, kMapHeaderSize> bytes{};
  encode_map_header(header, bytes);
  MapHeader back;
  ASSERT_EQ(decode_map_header(bytes, back), Status::ok);
  EXPECT_EQ(back.sequence, header.sequence);
  EXPECT_TRUE(back.window == header.window);
  EXPECT_EQ(back.occupied_from, 15);
  EXPECT_EQ(back.payload_bytes, 1000U);
  EXPECT_EQ(back.payload_crc, 0xDEADBEEFU);
  for (std::size_t bit = 0; bit < 8 * kMapHeaderSize; ++bit) {
    auto bad = bytes;
    bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1U << (bit % 8)));
    EXPECT_EQ(decode_map_header(bad, back), Status::corrupt) << bit;
  }
}

TEST(MapHeader, ErasedShortAndNewerAreToldApart) {
  std::array<std::uint8_t, kMapHeaderSize> bytes{};
  bytes.fill(0xFF);
  MapHeader header;
  EXPECT_EQ(decode_map_header(bytes, header), Status::not_ready);
  EXPECT_EQ(decode_map_header(ByteView{bytes}.first(10), header), Status::not_ready);
  header.window = {64, 64, 0.05F, 0, 0};
  encode_map_header(header, bytes);
  store_u16_le(bytes, 4, kMapFormatVersion + 1);
  store_u32_le(bytes, kMapHeaderSize - 4, crc32(ByteView{bytes}.first(kMapHeaderSize - 4)));
  EXPECT_EQ(decode_map_header(bytes, header), Status::unsupported);
}

TEST(RestoreCoarse, ACoarseCellIsItsMostOccupiedKnownCell) {
  const auto fine = std::make_unique<Map>();
  fine->core().place(-6, 10);  // no multiple of four
  const std::int8_t free = -60;
  const std::int8_t wall = 100;
  fine->core().restore(6, 2, {&free, 1});  // map cell (0, 12)
  fine->core().restore(7, 3, {&wall, 1});  // map cell (1, 13), the same coarse cell (0, 3)
  fine->core().restore(1, 0, {&free, 1});  // map cell (-5, 10): coarse (-2, 2)
  const auto coarse = std::make_unique<RollingMap<16, 16>>(MapConfig{.cell_m = 0.2F});
  place_coarse(fine->core(), coarse->core());
  for (int row = 0; row < 16; ++row) { restore_coarse_row(fine->core(), coarse->core(), row); }
  const GridWindow& window = coarse->core().window();
  EXPECT_EQ(window.origin_x_cells, -2);
  EXPECT_EQ(window.origin_y_cells, 2);
  const auto at = [&](int x, int y) {
    return coarse->core().occupancy()[static_cast<std::size_t>((y - 2) * 16 + x + 2)];
  };
  EXPECT_EQ(at(0, 3), 100);
  EXPECT_EQ(at(-2, 2), -60);
  EXPECT_EQ(at(1, 3), 0);
}

}  // namespace
}  // namespace picolo
