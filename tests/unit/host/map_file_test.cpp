// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/map_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "picolo/host/error.hpp"
#include "support/files.hpp"

namespace picolo {
namespace {

using host::MapCell;
using host::OccupancyImage;
using test::TemporaryFolder;

OccupancyImage small_map() {
  OccupancyImage map{4, 3, 0.5, -1.0, 2.0, {}};
  map.cells.assign(12, MapCell::unknown);
  map.cells[1 * 4 + 1] = MapCell::free;
  map.cells[2 * 4 + 2] = MapCell::occupied;
  return map;
}

TEST(MapFile, PgmIsTopRowFirstWithTheGreysOfMapServer) {
  const TemporaryFolder folder;
  write_map(folder.path(), "map", small_map());
  const std::string pgm = test::content_of(folder.path() / "map.pgm");
  const std::string head = "P5\n4 3\n255\n";
  ASSERT_EQ(pgm.substr(0, head.size()), head);
  const auto grey = [&](std::size_t column, std::size_t row_from_top) {
    return static_cast<unsigned char>(pgm.at(head.size() + row_from_top * 4 + column));
  };
  ASSERT_EQ(pgm.size(), head.size() + 12);
  EXPECT_EQ(grey(2, 0), 0);
  EXPECT_EQ(grey(1, 1), 254);
  EXPECT_EQ(grey(0, 2), 205);
}

TEST(MapFile, YamlNamesThePictureAndItsLowerLeftCorner) {
  const TemporaryFolder folder;
  write_map(folder.path(), "map", small_map());
  EXPECT_EQ(test::content_of(folder.path() / "map.yaml"),
            "image: map.pgm\nmode: trinary\nresolution: 0.5\norigin: [-1, 2, 0.0]\nnegate: 0\n"
            "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

TEST(MapFile, GreysReadBackAsTheyWereMeant) {
  // map_server: p = (255 - grey) / 255, occupied above 0.65, free below 0.196
  const auto occupancy = [](int grey) { return (255.0 - grey) / 255.0; };
  EXPECT_GT(occupancy(0), 0.65);
  EXPECT_LT(occupancy(254), 0.196);
  EXPECT_GT(occupancy(205), 0.196);
  EXPECT_LT(occupancy(205), 0.65);
}

TEST(MapFile, CropKeepsKnownCellsWhereTheyAre) {
  const OccupancyImage part = crop(small_map(), 1);
  EXPECT_EQ(part.width, 4U);
  EXPECT_EQ(part.height, 4U);
  EXPECT_EQ(part.origin_x_m, -1.0);
  EXPECT_EQ(part.origin_y_m, 2.0);
  EXPECT_EQ(part.at(1, 1), MapCell::free);
  EXPECT_EQ(part.at(2, 2), MapCell::occupied);
  const OccupancyImage tight = crop(small_map(), 0);
  EXPECT_EQ(tight.width, 2U);
  EXPECT_EQ(tight.origin_x_m, -0.5);
  EXPECT_EQ(tight.at(0, 0), MapCell::free);
  EXPECT_EQ(tight.at(1, 1), MapCell::occupied);
}

TEST(MapFile, CropOfAnUnknownMapIsTheMap) {
  OccupancyImage map{2, 2, 0.5, 0.0, 0.0, {}};
  map.cells.assign(4, MapCell::unknown);
  EXPECT_EQ(crop(map, 3).width, 2U);
}

constexpr const char* kHead = "resolution: 0.5\norigin: [-1.0, 2.0, 0.0]\n";

OccupancyImage read_text(const TemporaryFolder& folder, const std::string& yaml,
                         const std::string& pgm) {
  folder.write("map.pgm", pgm);
  return host::read_map(folder.write("map.yaml", yaml));
}

TEST(ReadMap, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  write_map(folder.path(), "map", small_map());
  const OccupancyImage back = host::read_map(folder.path() / "map.yaml");
  EXPECT_EQ(back.width, 4U);
  EXPECT_EQ(back.height, 3U);
  EXPECT_EQ(back.resolution_m, 0.5);
  EXPECT_EQ(back.origin_x_m, -1.0);
  EXPECT_EQ(back.origin_y_m, 2.0);
  EXPECT_EQ(back.cells, small_map().cells);
}

TEST(ReadMap, ModesNegateAndThresholdsFollowMapServer) {
  const TemporaryFolder folder;
  const std::string pgm = "P2 # text\n# made by hand\n5 1\n255\n0 60 128 200 255\n";
  const auto cells = [&](const std::string& more) {
    std::string text;
    for (const MapCell cell : read_text(folder, "image: map.pgm\n" + (kHead + more), pgm).cells) {
      text += cell == MapCell::occupied ? '#' : cell == MapCell::free ? '.' : '?';
    }
    return text;
  };
  // occupancy (255 - grey) / 255: 1, 0.765, 0.498, 0.216, 0
  EXPECT_EQ(cells("occupied_thresh: 0.65\nfree_thresh: 0.196\nnegate: 0\n"), "##??.");
  EXPECT_EQ(cells("occupied_thresh: 0.8\nfree_thresh: 0.25\nnegate: 0\n"), "#??..");
  EXPECT_EQ(cells("occupied_thresh: 0.65\nfree_thresh: 0.196\nnegate: 1\n"), ".??##");
  EXPECT_EQ(cells("mode: scale\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"), "##??.");
  EXPECT_EQ(cells("mode: raw\noccupied_thresh: 0.5\nfree_thresh: 0.2\n"), ".#???");
  EXPECT_EQ(cells(""), "##?..") << "map_server's defaults: 0.65 and 0.25";
}

TEST(ReadMap, TheTopRowIsTheFarthestAndListsMayStandInLines) {
  const TemporaryFolder folder;
  const OccupancyImage map = read_text(folder,
                                       "# a comment\nimage: \"map.pgm\"  # quoted\nresolution: "
                                       "0.1\norigin:\n- -3.5\n- +1\n- 0\nnegate: false\n",
                                       std::string{"P5\n1 2\n255\n"} + '\0' + '\xFE');
  EXPECT_EQ(map.at(0, 1), MapCell::occupied);
  EXPECT_EQ(map.at(0, 0), MapCell::free);
  EXPECT_EQ(map.origin_x_m, -3.5);
  EXPECT_EQ(map.origin_y_m, 1.0);
}

TEST(ReadMap, SixteenBitGreysAreBigEndian) {
  const TemporaryFolder folder;
  const std::string pixels{"\x00\x00\xFF\xFF", 4};
  const OccupancyImage map =
      read_text(folder, std::string{"image: map.pgm\n"} + kHead, "P5\n2 1\n65535\n" + pixels);
  EXPECT_EQ(map.at(0, 0), MapCell::occupied);
  EXPECT_EQ(map.at(1, 0), MapCell::free);
}

struct BadMap {
  const char* yaml;
  const char* pgm;
  const char* said;
};
class ReadBadMap : public ::testing::TestWithParam<BadMap> {};

TEST_P(ReadBadMap, NamesFileCauseAndCure) {
  const TemporaryFolder folder;
  try {
    static_cast<void>(read_text(folder, GetParam().yaml, GetParam().pgm));
    FAIL() << "accepted";
  } catch (const host::UserError& error) {
    EXPECT_EQ(error.code(), host::ExitCode::input);
    EXPECT_THAT(error.what(), ::testing::HasSubstr(GetParam().said));
  }
}
constexpr const char* kGoodPgm = "P2 1 1 255 0";
INSTANTIATE_TEST_SUITE_P(
    Kinds, ReadBadMap,
    ::testing::Values(
        BadMap{"image: map.pgm\norigin: [0, 0, 0]\n", kGoodPgm, "no 'resolution'"},
        BadMap{"image: map.pgm\nresolution: x\norigin: [0, 0, 0]\n", kGoodPgm,
               "map.yaml:2: 'resolution'"},
        BadMap{"image: map.pgm\nresolution: -1\norigin: [0, 0, 0]\n", kGoodPgm, "positive"},
        BadMap{"image: map.pgm\nresolution: 1\norigin: [0, 0, 0.5]\n", kGoodPgm, "yaw of 0"},
        BadMap{"image: map.pgm\nresolution: 1\norigin: [0]\n", kGoodPgm, "[x, y, yaw]"},
        BadMap{"image: other.pgm\nresolution: 1\norigin: [0, 0, 0]\n", kGoodPgm, "cannot be read"},
        BadMap{"image: .\nresolution: 1\norigin: [0, 0, 0]\n", kGoodPgm, "is a folder"},
        BadMap{"image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\nmode: odd\n", kGoodPgm,
               "trinary, scale or raw"},
        BadMap{"just words\n", kGoodPgm, "map.yaml:1"},
        BadMap{"image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\n", "\x89PNG", "no PGM"},
        BadMap{"image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\n", "P5\n9 9\n255\nabc",
               "3 bytes of pixels instead of 81"},
        BadMap{"image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\n", "P2 1 1 255 256", "above 255"},
        BadMap{"image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\n", "P5\n99999 1\n255\n",
               "width is above"}));

}  // namespace
}  // namespace picolo
