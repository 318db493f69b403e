// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/map_file.hpp"

#include <gtest/gtest.h>

#include <string>

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

}  // namespace
}  // namespace picolo
