// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The committed DBC file and page follow from the table, and outside decoders read the same values.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "support/dbc_reader.hpp"
#include "picolo/calibration/parameter.hpp"
#include "picolo/host/can_protocol.hpp"
#include "picolo/localisation/event_ring.hpp"
#include "random_frames.hpp"
#include "support/data.hpp"
#include "support/files.hpp"
#include "support/paths.hpp"

namespace picolo {
namespace {

constexpr std::uint16_t kBase = 0x110;

std::filesystem::path dbc_path() {
  return test::source_dir() / "docs/picolo.dbc";
}

TEST(CanProtocol, TheCommittedDbcIsThatOfTheTable) {
  EXPECT_EQ(test::content_of(dbc_path()), host::can_dbc(kBase))
      << "run: picolo protocol --dbc > docs/picolo.dbc";
}

TEST(CanProtocol, ThePagesTablesAreThoseOfTheTable) {
  const std::string page = test::content_of(test::source_dir() / "docs/can_protocol.md");
  EXPECT_NE(page.find("<!-- begin: picolo protocol --tables -->\n" + host::can_tables(kBase) +
                      "<!-- end -->\n"),
            std::string::npos)
      << "put the output of picolo protocol --tables between the marks";
}

template <typename Enum, std::size_t N>
void expect_names(const std::array<CanName, N>& names) {
  for (const CanName& name : names) {
    EXPECT_STREQ(name.text, to_string(static_cast<Enum>(name.value)));
  }
}

TEST(CanProtocol, NamesAreThoseOfTheLibrary) {
  expect_names<HealthState>(can_table::kHealthStateNames);
  expect_names<HealthReason>(can_table::kHealthReasonNames);
  expect_names<EventCode>(can_table::kEventCodeNames);
  expect_names<Parameter>(can_table::kParameterNames);
}

TEST(CanProtocol, ADbcReaderAgreesOn1000RandomFrames) {
  const test::Dbc dbc = test::read_dbc(test::content_of(dbc_path()));
  ASSERT_EQ(dbc.size(), can_table::kMessages.size());
  for (const test::RandomFrame& one : test::random_frames(kBase)) {
    const test::DbcMessage& message = dbc.at(one.frame.id);
    ASSERT_EQ(message.name, one.message->name);
    ASSERT_EQ(message.length, 8);
    ASSERT_EQ(message.signals.size(), one.message->signals.size() + 2);
    EXPECT_EQ(test::dbc_value(message.signals[0], one.frame.data), one.frame.data[0]);
    EXPECT_EQ(test::dbc_value(message.signals[1], one.frame.data), one.values.counter);
    for (std::size_t i = 0; i < one.message->signals.size(); ++i) {
      const CanSignal& signal = one.message->signals[i];
      const test::DbcSignal& read = message.signals[i + 2];
      ASSERT_EQ(read.name, signal.name);
      const double value = test::dbc_value(read, one.frame.data);
      EXPECT_GE(value, read.low - 1e-9);
      EXPECT_LE(value, read.high + 1e-9);
      const double ours = static_cast<double>(one.values.raw[i]) / signal.per_unit;
      EXPECT_NEAR(value, ours, 1e-9 * std::max(1.0, std::abs(ours))) << read.name;
      const double told = to_value(signal, one.values.raw[i]);
      EXPECT_TRUE(told == ours || std::isnan(told)) << read.name;
    }
  }
}

TEST(CanProtocol, TheDbcReaderWouldNoticeAShiftedBitAndAWrongSign) {
  std::string text = test::content_of(dbc_path());
  const std::string good = "x_m : 12|19@1-";
  text.replace(text.find(good), good.size(), "x_m : 13|19@1+");
  const test::Dbc dbc = test::read_dbc(text);
  const CanFrame frame =
      encode(can_table::kPose, kBase, 0, std::array{std::int64_t{-500}, std::int64_t{}});
  EXPECT_NE(test::dbc_value(dbc.at(0x110).signals[2], frame.data), -1.0);
}

/// "NAME a=1 b=2" as decode.js writes it.
std::map<std::string, double> values_of(const std::string& line) {
  std::map<std::string, double> values;
  std::istringstream words{line};
  std::string word;
  words >> word;
  while (words >> word) {
    const std::size_t equals = word.find('=');
    values[word.substr(0, equals)] = std::stod(word.substr(equals + 1));
  }
  return values;
}

TEST(CanProtocol, AnNpmDecoderAgreesOn1000RandomFrames) {
  const std::string node =
      std::string{"NODE_PATH="} + PICOLO_NODE_FOLDER + "/node_modules:" + "\"$NODE_PATH\" node ";
  const std::string quiet = " >/dev/null 2>&1";
  if (std::system((node + "-e \"require('candied')\"" + quiet).c_str()) != 0) {
    if (test::group_is_required("node")) { FAIL() << "PICOLO_REQUIRE asks for node with candied"; }
    GTEST_SKIP() << "no node with the package candied; npm install --prefix build/node candied";
  }
  const test::TemporaryFolder folder;
  const auto frames = test::random_frames(kBase);
  {
    std::ofstream file{folder.file("frames")};
    for (const test::RandomFrame& one : frames) {
      file << one.frame.id << ' ';
      for (const std::uint8_t byte : one.frame.data) {
        file << "0123456789abcdef"[byte >> 4] << "0123456789abcdef"[byte & 15];
      }
      file << '\n';
    }
  }
  const std::string script = (test::source_dir() / "tests/unit/can_protocol/decode.js").string();
  const std::string command = node + "'" + script + "' '" + dbc_path().string() + "' '" +
                              folder.file("frames") + "' > '" + folder.file("values") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::ifstream file{folder.file("values")};
  for (const test::RandomFrame& one : frames) {
    std::string line;
    ASSERT_TRUE(std::getline(file, line));
    EXPECT_EQ(line.substr(0, line.find(' ')), one.message->name);
    const auto values = values_of(line);
    ASSERT_EQ(values.size(), one.message->signals.size() + 2) << line;
    EXPECT_EQ(values.at("counter"), one.values.counter);
    for (std::size_t i = 0; i < one.message->signals.size(); ++i) {
      const CanSignal& signal = one.message->signals[i];
      const double ours = static_cast<double>(one.values.raw[i]) / signal.per_unit;
      EXPECT_NEAR(values.at(signal.name), ours, 1e-9 * std::max(1.0, std::abs(ours))) << line;
    }
  }
}

}  // namespace
}  // namespace picolo
