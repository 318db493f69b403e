// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/lidar_scans3.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>

#include "picolo/host/error.hpp"
#include "support/files.hpp"

namespace picolo {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::SizeIs;

template <typename T>
void put(std::string& bytes, T value) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof value);
  bytes.append(raw.data(), raw.size());
}

/// Two scans of two rings, 1 cm a step.
std::string l3d() {
  std::string bytes = "L3D1";
  for (const std::uint32_t word : {2U, 2U, 0U}) { put(bytes, word); }
  put(bytes, 0.01F);
  for (std::uint32_t scan = 0; scan < 2; ++scan) {
    put(bytes, scan);
    put(bytes, std::uint32_t{3});
    put(bytes, 0.1 * scan);
    for (int k = 0; k < 3; ++k) {
      for (const int along : {100 * (k + 1), -200, 50}) {
        put(bytes, static_cast<std::int16_t>(along));
      }
      put(bytes, static_cast<std::uint8_t>(k / 2));
      put(bytes, std::uint8_t{7});
    }
  }
  return bytes;
}

std::string error_of(const std::string& path) {
  try {
    host::ScanReader reader{path};
    host::RingScan scan;
    while (reader.next(scan)) {}
  } catch (const host::UserError& error) { return error.what(); }
  return {};
}

TEST(L3d, GivenALogThenScansComeByRing) {
  const TemporaryFolder folder;
  host::ScanReader reader{folder.write_gz("a.l3d.gz", l3d())};
  EXPECT_EQ(reader.scans(), 2U);
  EXPECT_EQ(reader.rings(), 2U);
  EXPECT_TRUE(reader.is_kitti());
  host::RingScan scan;
  ASSERT_TRUE(reader.next(scan));
  ASSERT_TRUE(reader.next(scan));
  EXPECT_DOUBLE_EQ(scan.stamp_s, 0.1);
  ASSERT_THAT(scan.rings, SizeIs(2));
  EXPECT_THAT(scan.rings[0], SizeIs(2));
  ASSERT_THAT(scan.rings[1], SizeIs(1));
  EXPECT_EQ(scan.size(), 3U);
  EXPECT_NEAR(scan.rings[1][0].point_m.x, 3.0F, 1e-6F);
  EXPECT_NEAR(scan.rings[1][0].point_m.y, -2.0F, 1e-6F);
  EXPECT_FALSE(reader.next(scan));
  EXPECT_EQ(reader.damage(), "");
}

TEST(L3d, GivenACutFileThenWholeScansAreKeptAndTheDamageIsNamed) {
  const TemporaryFolder folder;
  const std::string whole = l3d();
  host::ScanReader reader{folder.write("a.l3d", whole.substr(0, whole.size() - 5))};
  host::RingScan scan;
  EXPECT_TRUE(reader.next(scan));
  EXPECT_FALSE(reader.next(scan));
  EXPECT_THAT(reader.damage(), HasSubstr("cut in scan 1 of 2"));
}

TEST(L3d, GivenSomethingElseThenTheErrorNamesFileCauseAndCure) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of(folder.write("x.l3d", "something quite different")), HasSubstr("L3D1"));
  std::string zero = l3d();
  zero[8] = 0;
  EXPECT_THAT(error_of(folder.write("z.l3d", zero)), HasSubstr("0 rings"));
  EXPECT_THAT(error_of(folder.file("missing.l3d")), HasSubstr("missing.l3d"));
  EXPECT_THAT(error_of(folder.path().string()), HasSubstr("no .bin and no .ply"));
}

TEST(ScanFolder, GivenKittiFilesThenReturnsAreSortedIntoRings) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder.path() / "scans");
  std::string bytes;
  for (const double elevation : {3.0, -25.0}) {
    for (const double azimuth : {2.0, -1.0, 0.5}) {
      const double e = elevation * 3.14159265 / 180;
      put(bytes, static_cast<float>(10 * std::cos(e) * std::cos(azimuth)));
      put(bytes, static_cast<float>(10 * std::cos(e) * std::sin(azimuth)));
      put(bytes, static_cast<float>(10 * std::sin(e)));
      put(bytes, 0.5F);
    }
  }
  (void)folder.write("scans/000001.bin", bytes);
  (void)folder.write("scans/000000.bin", bytes.substr(0, 48));
  (void)folder.write("scans/notes.txt", "no scan");
  host::ScanReader reader{(folder.path() / "scans").string(),
                          {.rings = 8, .lowest_deg = -25.01, .highest_deg = 3.01}};
  EXPECT_EQ(reader.scans(), 2U);
  host::RingScan scan;
  ASSERT_TRUE(reader.next(scan));
  EXPECT_EQ(scan.size(), 3U);
  ASSERT_TRUE(reader.next(scan));
  ASSERT_THAT(scan.rings, SizeIs(8));
  ASSERT_THAT(scan.rings[0], SizeIs(3));
  ASSERT_THAT(scan.rings[7], SizeIs(3));
  EXPECT_LT(scan.rings[0][0].point_m.y, 0.0F);  // by azimuth
  EXPECT_LT(scan.rings[0][1].point_m.y, scan.rings[0][2].point_m.y + 10.0F);
  EXPECT_FALSE(reader.next(scan));
}

TEST(PointFiles, GivenPlyInAsciiAndBinaryThenTheSamePointsAreRead) {
  const TemporaryFolder folder;
  const std::string fields =
      "element vertex 2\nproperty uchar red\nproperty float x\nproperty double y\nproperty float "
      "z\n"
      "element face 0\nproperty list uchar int vertex_index\nend_header\n";
  std::string binary = "ply\nformat binary_little_endian 1.0\n" + fields;
  for (int i = 0; i < 2; ++i) {
    put(binary, std::uint8_t{9});
    put(binary, 1.5F + static_cast<float>(i));
    put(binary, -2.0);
    put(binary, 0.25F);
  }
  const std::string ascii = "ply\nformat ascii 1.0\n" + fields + "9 1.5 -2 0.25\n9 2.5 -2 0.25\n";
  for (const std::string& content : {binary, ascii}) {
    const auto points = host::read_ply(folder.write("a.ply", content));
    ASSERT_THAT(points, SizeIs(2));
    EXPECT_EQ(points[1], (Vector3f{2.5F, -2.0F, 0.25F}));
    EXPECT_THROW((void)host::read_ply(folder.write("b.ply", content.substr(0, content.size() - 8))),
                 host::UserError);
  }
}

TEST(PointFiles, GivenFilesThatAreNoPlyThenTheyAreRefused) {
  const TemporaryFolder folder;
  for (const std::string content :
       {"nothing", "ply\nformat binary_big_endian 1.0\nelement vertex 0\nend_header\n",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty strange x\nend_header\n1\n"}) {
    EXPECT_THROW((void)host::read_ply(folder.write("a.ply", content)), host::UserError);
  }
  EXPECT_THROW((void)host::read_float_points(folder.write("a.bin", "12345"), 3), host::UserError);
}

TEST(CorrectElevation, TurnsReturnsUpAboutTheirOwnHorizontalAxis) {
  host::RingScan scan;
  scan.rings = {{{{3.0F, 4.0F, 0.0F}, 0.0F}, {{0.0F, 0.0F, 1.0F}, 0.0F}}};
  correct_elevation(scan, 0.1);
  const Vector3f& p = scan.rings[0][0].point_m;
  EXPECT_NEAR(p.z, 5 * std::sin(0.1F), 1e-6F);
  EXPECT_NEAR(std::hypot(p.x, p.y), 5 * std::cos(0.1F), 1e-6F);
  EXPECT_NEAR(p.y / p.x, 4.0F / 3.0F, 1e-6F);
  EXPECT_EQ(scan.rings[0][1].point_m, (Vector3f{0, 0, 1}));
}

}  // namespace
}  // namespace picolo
