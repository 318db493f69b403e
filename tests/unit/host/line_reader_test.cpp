// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/line_reader.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "picolo/host/error.hpp"
#include "support/files.hpp"

namespace picolo {
namespace {

using test::TemporaryFolder;

std::vector<std::string> lines_of(host::LineReader& reader) {
  std::vector<std::string> lines;
  std::string_view line;
  while (reader.next(line)) { lines.emplace_back(line); }
  return lines;
}

/// Lines that compress badly, so that a cut falls where data is, not into one long match.
std::string long_text(int count) {
  std::mt19937 random{42};
  std::string text;
  for (int i = 0; i < count; ++i) {
    text += "LINE " + std::to_string(i) + " " + std::to_string(random()) + "\n";
  }
  return text;
}

TEST(LineReader, PlainLinesComeWithTheirNumbers) {
  const TemporaryFolder folder;
  host::LineReader reader{folder.write("a.log", "one\n\nthree\n")};
  std::string_view line;
  ASSERT_TRUE(reader.next(line));
  EXPECT_EQ(line, "one");
  EXPECT_EQ(reader.line_number(), 1U);
  ASSERT_TRUE(reader.next(line));
  EXPECT_EQ(line, "");
  ASSERT_TRUE(reader.next(line));
  EXPECT_EQ(line, "three");
  EXPECT_EQ(reader.line_number(), 3U);
  EXPECT_FALSE(reader.next(line));
  EXPECT_FALSE(reader.next(line)) << "the end stays the end";
  EXPECT_EQ(reader.damage(), "");
}

TEST(LineReader, LastLineWithoutLineEndingCountsAndCarriageReturnsDoNot) {
  const TemporaryFolder folder;
  host::LineReader reader{folder.write("a.log", "one\r\ntwo")};
  EXPECT_EQ(lines_of(reader), (std::vector<std::string>{"one", "two"}));
}

TEST(LineReader, AnEmptyFileHasNoLines) {
  const TemporaryFolder folder;
  host::LineReader reader{folder.write("a.log", "")};
  EXPECT_TRUE(lines_of(reader).empty());
  EXPECT_EQ(reader.damage(), "");
}

TEST(LineReader, GzipIsRecognisedByContentNotByName) {
  const TemporaryFolder folder;
  const std::string text = long_text(20'000);
  host::LineReader packed{folder.write_gz("packed.log", text)};
  host::LineReader plain{folder.write("plain.gz", text)};
  const auto lines = lines_of(packed);
  EXPECT_EQ(lines.size(), 20'000U);
  EXPECT_EQ(lines, lines_of(plain));
  EXPECT_EQ(packed.damage(), "");
}

TEST(LineReader, ConcatenatedGzipMembersAreOneFile) {
  const TemporaryFolder folder;
  const std::string first = test::content_of(folder.write_gz("1.gz", "one\n"));
  const std::string second = test::content_of(folder.write_gz("2.gz", "two\n"));
  host::LineReader reader{folder.write("both.gz", first + second + std::string(64, '\0'))};
  EXPECT_EQ(lines_of(reader), (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(reader.damage(), "");
}

TEST(LineReader, EveryCutOfAGzipKeepsAPrefixOfWholeLinesAndSaysSo) {
  const TemporaryFolder folder;
  const std::string text = long_text(40);
  host::LineReader whole{folder.write("whole.log", text)};
  const auto all = lines_of(whole);
  const std::string packed = test::content_of(folder.write_gz("a.gz", text));
  for (std::size_t size = 3; size < packed.size(); ++size) {
    host::LineReader reader{folder.write("cut.gz", packed.substr(0, size))};
    const auto lines = lines_of(reader);
    ASSERT_LE(lines.size(), all.size());
    ASSERT_TRUE(std::equal(lines.begin(), lines.end(), all.begin())) << size;
    ASSERT_NE(reader.damage(), "") << size;
  }
}

TEST(LineReader, ACutLongGzipKeepsMostOfWhatIsThere) {
  const TemporaryFolder folder;
  const std::string packed = test::content_of(folder.write_gz("a.gz", long_text(20'000)));
  host::LineReader reader{folder.write("cut.gz", packed.substr(0, packed.size() / 2))};
  EXPECT_GT(lines_of(reader).size(), 9'000U);
  EXPECT_NE(reader.damage().find("truncated"), std::string::npos);
}

TEST(LineReader, DamagedBytesInTheMiddleKeepWhatCameBefore) {
  const TemporaryFolder folder;
  std::string packed = test::content_of(folder.write_gz("a.gz", long_text(20'000)));
  for (std::size_t i = packed.size() / 2; i < packed.size() / 2 + 64; ++i) { packed[i] = '\xFF'; }
  host::LineReader reader{folder.write("bad.gz", packed)};
  EXPECT_GT(lines_of(reader).size(), 5'000U);
  EXPECT_NE(reader.damage().find("damaged"), std::string::npos);
}

TEST(LineReader, MissingFilesAndFoldersAreInputErrorsThatNameThem) {
  const TemporaryFolder folder;
  for (const std::string& path : {folder.file("missing.log"), folder.path().string()}) {
    try {
      host::LineReader reader{path};
      FAIL() << path;
    } catch (const host::UserError& error) {
      EXPECT_EQ(error.code(), host::ExitCode::input);
      EXPECT_EQ(std::string{error.what()}.rfind(path + ": ", 0), 0U) << error.what();
    }
  }
}

}  // namespace
}  // namespace picolo
