// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/picture.hpp"

#include <gtest/gtest.h>
#include <png.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "support/files.hpp"

namespace picolo {
namespace {

using test::TemporaryFolder;

struct Decoded {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<unsigned char> rgb;

  [[nodiscard]] std::size_t count(const host::Colour& colour) const {
    std::size_t pixels = 0;
    for (std::size_t i = 0; i < rgb.size(); i += 3) {
      pixels += static_cast<std::size_t>(rgb[i] == colour.red && rgb[i + 1] == colour.green &&
                                         rgb[i + 2] == colour.blue);
    }
    return pixels;
  }
  [[nodiscard]] bool green(std::size_t column, std::size_t row) const {
    const std::size_t at = 3 * (row * width + column);
    return rgb[at + 1] > rgb[at] + 60;
  }
  [[nodiscard]] double green_columns() const {
    double columns = 0.0;
    for (std::size_t x = 0; x < width; ++x) {
      bool any = false;
      for (std::size_t y = 0; y < height; ++y) { any = any || green(x, y); }
      columns += any ? 1.0 : 0.0;
    }
    return columns;
  }
  [[nodiscard]] double green_rows() const {
    double rows = 0.0;
    for (std::size_t y = 0; y < height; ++y) {
      bool any = false;
      for (std::size_t x = 0; x < width; ++x) { any = any || green(x, y); }
      rows += any ? 1.0 : 0.0;
    }
    return rows;
  }
};

Decoded decode(const std::string& path) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_file(&image, path.c_str()), 0) << image.message;
  image.format = PNG_FORMAT_RGB;
  Decoded decoded{image.width, image.height, std::vector<unsigned char>(PNG_IMAGE_SIZE(image))};
  EXPECT_NE(png_image_finish_read(&image, nullptr, decoded.rgb.data(), 0, nullptr), 0);
  return decoded;
}

host::Picture sample() {
  host::Picture picture;
  picture.title = "Title & <figures>";
  picture.note = "APE 0.123 m";
  host::OccupancyImage map{100, 100, 0.1, 0.0, 0.0, {}};
  map.cells.assign(10'000, host::MapCell::free);
  for (std::size_t i = 0; i < 100; ++i) { map.cells[50 * 100 + i] = host::MapCell::occupied; }
  picture.maps.push_back(map);
  picture.lines.push_back({{{1.0, 1.0}, {9.0, 1.0}, {9.0, 9.0}}, host::palette::kPicolo, 3.0, "p"});
  picture.points.push_back({{{2.0, 8.0}}, host::palette::kOdometry, 4.0, "dots"});
  return picture;
}

TEST(Picture, PngDecodesWithEveryLayerInItsColour) {
  const TemporaryFolder folder;
  write_png(sample(), folder.file("a.png"));
  const Decoded png = decode(folder.file("a.png"));
  EXPECT_GT(png.width, 1100U);
  EXPECT_GT(png.height, 420U);
  EXPECT_GT(png.count(host::palette::kPicolo), 2000U);
  EXPECT_GT(png.count(host::palette::kOdometry), 30U);
  EXPECT_GT(png.count(host::palette::kOccupied), 500U);
  EXPECT_GT(png.count(host::palette::kUnknown), 1000U) << "around the map";
  EXPECT_GT(png.count(host::palette::kFree), 100'000U);
}

TEST(Picture, ALengthInMetresHasTheSameLengthInBothDirections) {
  const TemporaryFolder folder;
  host::Picture picture = sample();
  picture.maps.clear();
  picture.points.clear();
  picture.lines[0].label.clear();
  picture.lines[0].points_m = {{0.0, 4.0}, {8.0, 4.0}};
  picture.keep_in_view_m = {{0.0, 0.0}, {8.0, 8.0}};
  write_png(picture, folder.file("x.png"));
  picture.lines[0].points_m = {{4.0, 0.0}, {4.0, 8.0}};
  write_png(picture, folder.file("y.png"));
  EXPECT_NEAR(decode(folder.file("x.png")).green_columns(),
              decode(folder.file("y.png")).green_rows(), 2.0);
  EXPECT_GT(decode(folder.file("x.png")).green_columns(), 500.0);
}

TEST(Picture, SvgIsOneDocumentWithEscapedText) {
  const TemporaryFolder folder;
  write_svg(sample(), folder.file("a.svg"));
  const std::string svg = test::content_of(folder.file("a.svg"));
  EXPECT_EQ(svg.rfind("<svg ", 0), 0U);
  EXPECT_NE(svg.find("</svg>"), std::string::npos);
  EXPECT_NE(svg.find("Title &amp; &lt;figures&gt;"), std::string::npos);
  EXPECT_NE(svg.find("data:image/png;base64,"), std::string::npos);
  std::size_t opened = 0;
  std::size_t closed = 0;
  for (std::size_t at = svg.find("<g"); at != std::string::npos; at = svg.find("<g", at + 1)) {
    ++opened;
  }
  for (std::size_t at = svg.find("</g>"); at != std::string::npos; at = svg.find("</g>", at + 1)) {
    ++closed;
  }
  EXPECT_EQ(opened, closed);
}

TEST(Picture, NothingOnePointAndNotANumberAreDrawnToo) {
  const TemporaryFolder folder;
  host::Picture picture;
  EXPECT_NO_THROW(write_picture(picture, folder.path(), "empty"));
  picture.points.push_back({{{5.0, 5.0}}, {}, 1.0, "one"});
  picture.lines.push_back({{{5.0, 5.0}, {std::nan(""), 0.0}, {5.0, HUGE_VAL}}, {}, 1.0, "odd"});
  EXPECT_NO_THROW(write_picture(picture, folder.path(), "one"));
  EXPECT_GT(decode(folder.file("one.png")).width, 0U);
}

TEST(Picture, ALargeMapShrinksWithoutLosingItsWalls) {
  const TemporaryFolder folder;
  host::Picture picture;
  host::OccupancyImage map{4000, 4000, 0.05, 0.0, 0.0, {}};
  map.cells.assign(16'000'000, host::MapCell::free);
  for (std::size_t i = 0; i < 4000; ++i) { map.cells[i * 4000 + 2000] = host::MapCell::occupied; }
  picture.maps.push_back(map);
  write_png(picture, folder.file("a.png"));
  std::size_t dark = 0;
  const Decoded png = decode(folder.file("a.png"));
  for (std::size_t i = 0; i < png.rgb.size(); i += 3) { dark += png.rgb[i] < 150 ? 1U : 0U; }
  EXPECT_GT(dark, 900U) << "a wall of one cell over the whole height";
}

}  // namespace
}  // namespace picolo
