// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A file as flash: what survives, what is refused, what a crash may leave behind.

#include "picolo/linux/file_byte_store.hpp"

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <vector>

#include "pseudo_terminal.hpp"

namespace picolo {
namespace {

class FileByteStoreTest : public ::testing::Test {
 protected:
  [[nodiscard]] std::string path() const { return (folder.path() / "store").string(); }

  test::TemporaryFolder folder;
  FileByteStoreConfig config{.geometry = {.size = 8192, .sector = 2048, .granule = 8}};
};

TEST_F(FileByteStoreTest, GivenNoFileThenAnErasedOneOfTheRightSizeIsMade) {
  FileByteStore store{config};
  ASSERT_EQ(store.open(path().c_str()), Status::ok);
  EXPECT_EQ(std::filesystem::file_size(path()), 8192U);
  std::vector<std::uint8_t> all(8192);
  ASSERT_EQ(store.read(0, all), Status::ok);
  for (const std::uint8_t byte : all) { ASSERT_EQ(byte, 0xFF); }
  EXPECT_FALSE(std::filesystem::exists(path() + ".new"));
}

TEST_F(FileByteStoreTest, GivenAHalfMadeFileOfACrashThenItIsNotMistakenForTheStore) {
  std::ofstream{path() + ".new"} << "torn";
  FileByteStore store{config};
  ASSERT_EQ(store.open(path().c_str()), Status::ok);
  EXPECT_EQ(std::filesystem::file_size(path()), 8192U);
}

TEST_F(FileByteStoreTest, GivenAFileOfAnotherSizeThenItIsCorruptAndLeftAlone) {
  std::ofstream{path()} << "something else";
  FileByteStore store{config};
  EXPECT_EQ(store.open(path().c_str()), Status::corrupt);
  EXPECT_FALSE(store.is_open());
  EXPECT_EQ(std::filesystem::file_size(path()), 14U);
}

TEST_F(FileByteStoreTest, GivenASecondOpenerThenItIsTurnedAway) {
  FileByteStore first{config};
  FileByteStore second{config};
  ASSERT_EQ(first.open(path().c_str()), Status::ok);
  EXPECT_EQ(second.open(path().c_str()), Status::not_ready);
}

TEST_F(FileByteStoreTest, GivenWritesThenTheNextProcessReadsThem) {
  constexpr std::array<std::uint8_t, 16> kData{1, 2,  3,  4,  5,  6,  7,  8,
                                               9, 10, 11, 12, 13, 14, 15, 16};
  {
    FileByteStore store{config};
    ASSERT_EQ(store.open(path().c_str()), Status::ok);
    ASSERT_EQ(store.program(2040, kData), Status::ok);
  }
  FileByteStore store{config};
  ASSERT_EQ(store.open(path().c_str()), Status::ok);
  std::array<std::uint8_t, 16> back{};
  ASSERT_EQ(store.read(2040, back), Status::ok);
  EXPECT_EQ(back, kData);
  EXPECT_EQ(store.erase(2048), Status::ok);
  ASSERT_EQ(store.read(2040, back), Status::ok);
  EXPECT_EQ(back[7], 8);
  EXPECT_EQ(back[8], 0xFF);
}

TEST_F(FileByteStoreTest, GivenALongWriteThenEveryByteArrives) {
  FileByteStore store{config};
  ASSERT_EQ(store.open(path().c_str()), Status::ok);
  std::vector<std::uint8_t> data(8192);
  for (std::size_t i = 0; i < data.size(); ++i) { data[i] = static_cast<std::uint8_t>(i * 31); }
  ASSERT_EQ(store.program(0, data), Status::ok);
  std::vector<std::uint8_t> back(8192);
  ASSERT_EQ(store.read(0, back), Status::ok);
  EXPECT_EQ(back, data);
}

TEST_F(FileByteStoreTest, GivenBadConfigurationsThenTheyAreRefused) {
  config.geometry.sector = 2047;
  FileByteStore uneven{config};
  EXPECT_EQ(uneven.open(path().c_str()), Status::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(path()));
  FileByteStore nowhere{};
  EXPECT_EQ(nowhere.open("/no/such/folder/store"), Status::io_error);
  EXPECT_EQ(nowhere.open((folder.path() / std::string(200, 'x') / "y").c_str()), Status::io_error);
}

TEST_F(FileByteStoreTest, GivenAClosedStoreThenEveryCallFails) {
  FileByteStore store{config};
  std::array<std::uint8_t, 8> bytes{};
  EXPECT_EQ(store.read(0, bytes), Status::io_error);
  EXPECT_EQ(store.program(0, bytes), Status::io_error);
  EXPECT_EQ(store.erase(0), Status::io_error);
}

}  // namespace
}  // namespace picolo
