// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>
#include <vector>

#include "picolo/drivers/scip/scip.hpp"
#include "support/bytes.hpp"
#include "support/fake_serial_port.hpp"
#include "support/vectors.hpp"

namespace picolo::test {
namespace {

constexpr const char* kSession = "drivers/hokuyo/urg_04lx.raw";

void add_line(Bytes& out, const std::string& text, bool with_sum) {
  const Bytes bytes{text.begin(), text.end()};
  out.insert(out.end(), bytes.begin(), bytes.end());
  if (with_sum) { out.push_back(scip_sum(bytes)); }
  out.push_back('\n');
}

/// What a device answers for one scan of an MD command.
Bytes scan_bytes(std::size_t first, std::size_t last, std::uint32_t time_ms, std::uint32_t base) {
  auto coded = [](std::uint32_t value, int size) {
    std::string text;
    for (int i = size - 1; i >= 0; --i) {
      text.push_back(static_cast<char>(((value >> (6 * i)) & 0x3FU) + 0x30U));
    }
    return text;
  };
  Bytes out;
  char echo[16];
  std::snprintf(echo, sizeof echo, "MD%04zu%04zu01000", first, last);
  add_line(out, echo, false);
  add_line(out, "99b", false);
  add_line(out, coded(time_ms & 0xFFFFFFU, 4), true);
  std::string data;
  for (std::size_t step = first; step <= last; ++step) {
    data += coded(base + static_cast<std::uint32_t>(step), 3);
  }
  for (std::size_t at = 0; at < data.size(); at += 64) { add_line(out, data.substr(at, 64), true); }
  out.push_back('\n');
  return out;
}

std::vector<RangeReading> read_all(Scip& lidar) {
  std::vector<RangeReading> all;
  std::array<RangeReading, 48> readings{};
  constexpr std::size_t kAll = 10'000'000;
  for (auto count = lidar.poll(kAll, readings); count; count = lidar.poll(kAll, readings)) {
    all.insert(all.end(), readings.begin(), readings.begin() + static_cast<std::ptrdiff_t>(*count));
  }
  return all;
}

std::vector<RangeReading> read_all(const std::vector<Bytes>& pieces,
                                   const ScipConfig& config = {.active = false}) {
  FakeSerialPort port{250'000};
  Timestamp stamp{10s};
  for (const Bytes& piece : pieces) {
    stamp += transmission_time(piece.size(), port.baud());
    port.arrives(stamp, piece);
  }
  Scip lidar{port, config};
  return read_all(lidar);
}

TEST(Scip, GivenTheRecordedSessionThenTheScanIsAsPublished) {
  PICOLO_NEED_DATA(kSession);
  std::ifstream file{data_path(kSession), std::ios::binary};
  const Bytes stream{std::istreambuf_iterator<char>{file}, {}};
  std::ifstream expected_file{data_path("drivers/hokuyo/urg_04lx.decoded.json")};
  const auto expected = nlohmann::json::parse(expected_file).at("scans").at(0);

  ScipProtocol protocol{{.active = false}};
  std::array<RangeReading, 1> none{};
  bool seen = false;
  for (const std::uint8_t byte : stream) {
    protocol.push(byte, {}, none);
    if (!protocol.scan_ready()) { continue; }
    seen = true;
    const ScipScan& scan = protocol.scan();
    EXPECT_EQ(scan.time_ms(), expected.at("ts_ms").get<unsigned>());
    const auto& values = expected.at("values");
    ASSERT_EQ(scan.command().values(), values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      ASSERT_EQ(scan.value(i), values[i].get<unsigned>()) << i;
    }
    std::vector<RangeReading> readings(values.size());
    ASSERT_EQ(protocol.pull(readings), values.size());
    // The answer to PP has told the geometry: 1024 steps a turn, step 384 ahead.
    EXPECT_NEAR(readings[0].bearing_rad, (44 - 384) * 2 * std::numbers::pi / 1024, 1e-5);
    EXPECT_NEAR(readings[681].bearing_rad, (725 - 384) * 2 * std::numbers::pi / 1024, 1e-5);
    EXPECT_FLOAT_EQ(readings[0].range_m, 0.392F);
    EXPECT_NEAR(to_seconds(readings[681].stamp - readings[0].stamp), 681 * 0.1 / 1024, 1e-5);
  }
  EXPECT_TRUE(seen);
  EXPECT_EQ(protocol.counters().bad_checksums, 0U);
  EXPECT_EQ(protocol.model().max_mm, 5600U);
}

/// u32 seconds, microseconds, length in network order, then what was read then.
TEST(Scip, GivenTheArrivalTimesOfTheRecordedSessionThenTheScanComesWithItsLastSum) {
  PICOLO_NEED_DATA("drivers/hokuyo/example_urg_04lx.logr");
  std::ifstream file{data_path("drivers/hokuyo/example_urg_04lx.logr"), std::ios::binary};
  const Bytes log{std::istreambuf_iterator<char>{file}, {}};
  auto word = [&log](std::size_t at) {
    return std::uint32_t{log[at]} << 24U | std::uint32_t{log[at + 1]} << 16U |
           std::uint32_t{log[at + 2]} << 8U | log[at + 3];
  };
  ScipProtocol protocol{{.active = false}};
  std::array<RangeReading, 682> readings{};
  Timestamp began{};
  Timestamp handed_out{};
  std::size_t count = 0;
  std::size_t behind = 0;
  for (std::size_t at = 0; at + 12 <= log.size(); at += 12 + word(at + 8)) {
    const Timestamp arrived{std::chrono::seconds{word(at)} + Duration{word(at + 4)}};
    for (std::size_t i = 0; i < word(at + 8); ++i) {
      const std::uint8_t byte = log[at + 12 + i];
      if (byte == 'G') { began = arrived; }  // the last one is that of the echo GD0044072501
      protocol.push(byte, {.arrived = arrived, .baud = 19'200}, readings);
      behind += count > 0 ? 1U : 0U;
      if (!protocol.scan_ready()) { continue; }
      handed_out = arrived;
      count = protocol.pull(readings);
    }
  }
  ASSERT_EQ(count, 682U);
  EXPECT_EQ(behind, 1U) << "the empty line";
  EXPECT_TRUE(readings[0].starts_sweep && readings[681].ends_sweep);
  EXPECT_LE(readings[681].stamp, handed_out);
  EXPECT_LT(readings[0].stamp, began);
  EXPECT_LE(protocol.counters().skipped_bytes, 60U) << "echoes of other commands have no sum";
}

TEST(Scip, GivenAnyCutOfTheStreamThenTheReadingsAreTheSame) {
  Bytes stream;
  for (std::uint32_t i = 0; i < 5; ++i) {
    stream = join({stream, scan_bytes(0, 1080, 100 + 25 * i, 1000 * i + 500)});
  }
  const auto whole = read_all({stream});
  ASSERT_EQ(whole.size(), 5U * 1081U);
  EXPECT_EQ(std::count_if(whole.begin(), whole.end(), [](auto& r) { return r.starts_sweep; }), 5);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const auto pieces = read_all(cut_randomly(stream, 1 + seed * 40, seed));
    ASSERT_EQ(pieces.size(), whole.size());
    for (std::size_t i = 0; i < whole.size(); ++i) {
      ASSERT_EQ(pieces[i].stamp, whole[i].stamp);
      ASSERT_EQ(pieces[i].range_m, whole[i].range_m);
    }
  }
}

TEST(Scip, GivenADamagedLineThenOnlyItsValuesAreLostAndNoneMoves) {
  const Bytes scan = scan_bytes(0, 1080, 100, 500);
  const auto whole = read_all({scan});
  ASSERT_EQ(whole.size(), 1081U);
  for (std::size_t at = 16 + 4 + 6; at + 1 < scan.size(); at += 5) {
    for (const Bytes& damaged :
         {with_bit_flipped(scan, 8 * at), without_byte(scan, at), with_byte(scan, at, '\n')}) {
      const auto readings = read_all({damaged, scan_bytes(0, 1080, 125, 700)});
      ASSERT_EQ(readings.size(), 2 * whole.size()) << at;
      std::size_t lost = 0;
      for (std::size_t i = 0; i < whole.size(); ++i) {
        lost += readings[i].range_m == 0.0F ? 1U : 0U;
        ASSERT_TRUE(readings[i].range_m == 0.0F || readings[i].range_m == whole[i].range_m) << at;
      }
      ASSERT_LE(lost, 45U) << at;  // two lines, when the line feed between them was hit
    }
  }
}

TEST(Scip, GivenTheSumOfItsLastLineThenTheScanIsHandedOut) {
  const Bytes scan = scan_bytes(0, 1080, 100, 500);
  // The line feed behind the sum; the empty line that follows tells nothing.
  const auto readings = read_all({Bytes{scan.begin(), scan.end() - 1}});
  ASSERT_EQ(readings.size(), 1081U);
  for (std::size_t i = 0; i < readings.size(); ++i) {
    EXPECT_EQ(readings[i].starts_sweep, i == 0);
    EXPECT_EQ(readings[i].ends_sweep, i + 1 == readings.size());
  }
  EXPECT_TRUE(read_all({Bytes{scan.begin(), scan.end() - 2}}).empty());
  FakeSerialPort port{250'000};
  port.arrives(Timestamp{1s}, join({scan, scan}));
  Scip lidar{port, {.active = false}};
  EXPECT_EQ(read_all(lidar).size(), 2U * 1081U);
  EXPECT_EQ(lidar.counters().skipped_bytes, 0U);
}

TEST(Scip, GivenAPieceOfAScanIsMissingThenTheScanIsRefusedAndTheNextIsRead) {
  const Bytes scan = scan_bytes(0, 1080, 100, 500);
  for (const std::size_t missing : {64U, 66U, 132U, 500U}) {
    Bytes cut{scan.begin(), scan.begin() + 300};
    cut.insert(cut.end(), scan.begin() + 300 + static_cast<std::ptrdiff_t>(missing), scan.end());
    const auto readings = read_all({cut, scan_bytes(0, 1080, 125, 700)});
    ASSERT_EQ(readings.size(), 1081U) << missing;
    EXPECT_FLOAT_EQ(readings[0].range_m, 0.7F);
  }
}

TEST(Scip, GivenTheDeviceClockThenLateDeliveryDoesNotMoveTheScans) {
  FakeSerialPort port{250'000};
  Timestamp last{};
  for (std::uint32_t i = 0; i < 100; ++i) {
    const Bytes scan = scan_bytes(0, 1080, 16'777'200 + 25 * i, 500);  // wraps at 2^24
    const Timestamp due = Timestamp{1s} + i * 25ms;
    const Duration late = i % 3 == 0 && i > 20 ? 11ms : 0ms;
    port.arrives(due + late, scan);
  }
  Scip lidar{port, {.active = false}};
  int scans = 0;
  for (const RangeReading& reading : read_all(lidar)) {
    if (!reading.starts_sweep) { continue; }
    ++scans;
    if (scans > 22) { EXPECT_NEAR(to_seconds(reading.stamp - last), 0.025, 0.0016); }
    last = reading.stamp;
  }
  EXPECT_EQ(scans, 100);
  EXPECT_EQ(lidar.counters().clock_restarts, 0U);
}

TEST(Scip, GivenADeviceThatAnswersThenItIsAskedForItsWholeRange) {
  FakeSerialPort port{115'200};
  Scip lidar{port};
  std::array<RangeReading, 48> readings{};
  Bytes answer;
  for (const char* line : {"PP", "00P"}) { add_line(answer, line, false); }
  for (const char* line : {"DMIN:20;", "DMAX:5600;", "ARES:1024;", "AMIN:44;", "AMAX:725;",
                           "AFRT:384;", "SCAN:600;"}) {
    const std::string text{line};
    const Bytes body{text.begin(), text.end() - 1};
    answer.insert(answer.end(), text.begin(), text.end());
    answer.push_back(scip_sum(body));
    answer.push_back('\n');
  }
  Timestamp now{1s};
  for (int i = 0; i < 300; ++i) {
    now += 5ms;
    if (i == 40) { port.arrives(now, answer); }
    static_cast<void>(lidar.poll(256, readings));
    ASSERT_EQ(lidar.service(now), Status::ok);
  }
  const std::string sent{port.written().begin(), port.written().end()};
  EXPECT_EQ(sent, "QT\nSCIP2.0\nPP\nBM\nMD0044072501000\n");
  EXPECT_EQ(lidar.stop(), Status::ok);
  EXPECT_EQ(port.written().back(), '\n');
}

}  // namespace
}  // namespace picolo::test
