// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// picolo doctor on set-ups that are broken on purpose: pseudo-terminals that a test plays, and the
// simulated vehicle.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <thread>

#include "played_line.hpp"
#include "tool_run.hpp"

namespace picolo {
namespace {

using test::run_tool;
using test::TemporaryFolder;
using test::ToolRun;
using ::testing::HasSubstr;

/// Sends LD06 packets of a recording while it lives; only when the line has the right rate, as
/// nobody reads sense from a line of another.
class TalkingLidar {
 public:
  TalkingLidar(const std::string& bytes, std::uint32_t rate, std::size_t damage_every = 0)
      : bytes_(bytes), rate_(rate), damage_every_(damage_every), thread_([this] { talk(); }) {}
  ~TalkingLidar() {
    done_ = true;
    thread_.join();
  }
  TalkingLidar(const TalkingLidar&) = delete;
  TalkingLidar& operator=(const TalkingLidar&) = delete;
  [[nodiscard]] std::string path() const { return line_.path(); }

 private:
  void talk() {
    constexpr std::size_t kPacket = 47;
    for (std::size_t i = 0; !done_; ++i) {
      const std::size_t begin = (i * kPacket) % (bytes_.size() - kPacket);
      std::array<std::uint8_t, kPacket> packet{};
      for (std::size_t k = 0; k < kPacket; ++k) {
        packet[k] = static_cast<std::uint8_t>(bytes_[begin + k]);
      }
      if (damage_every_ != 0 && i % damage_every_ == 0) { packet[20] ^= 0x55; }
      if (line_.rate() != rate_) {
        for (std::uint8_t& byte : packet) { byte = static_cast<std::uint8_t>(byte >> 2); }
      }
      line_.send(packet);
      std::this_thread::sleep_for(std::chrono::milliseconds{2});
    }
  }

  std::string bytes_;
  std::uint32_t rate_;
  std::size_t damage_every_;
  test::PlayedLine line_;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

class Doctor : public ::testing::Test {
 protected:
  /// What a lidar has sent in a second of the demo.
  [[nodiscard]] std::string lidar_bytes() const {
    const ToolRun run = run_tool(folder, {"demo", "--seconds", "1", "--record", "rec"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return test::content_of(folder.path() / "rec/lidar.raw");
  }
  TemporaryFolder folder;
};

TEST_F(Doctor, AHealthyLidar) {
  const TalkingLidar lidar{lidar_bytes(), 230'400};
  const ToolRun run = run_tool(folder, {"doctor", "--lidar", lidar.path()});
  EXPECT_EQ(run.exit_code, 0) << run.out;
  EXPECT_THAT(run.out, HasSubstr("nothing wrong"));
}

TEST_F(Doctor, ALineThatDoesNotExistAndOneThatIsNone) {
  const ToolRun none = run_tool(folder, {"doctor", "--lidar", "nowhere"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.out, HasSubstr("does not exist"));
  folder.write("file", "");
  EXPECT_THAT(run_tool(folder, {"doctor", "--imu", "file"}).out, HasSubstr("no serial line"));
}

TEST_F(Doctor, ALidarThatIsSilent) {
  const test::PlayedLine line;
  const ToolRun run = run_tool(folder, {"doctor", "--lidar", line.path()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("no bytes come"));
  EXPECT_THAT(run.out, HasSubstr("powered"));
}

TEST_F(Doctor, ALidarAtAnotherRateIsFoundThere) {
  const TalkingLidar lidar{lidar_bytes(), 115'200};
  const ToolRun run = run_tool(folder, {"doctor", "--lidar", lidar.path(), "--json"});
  EXPECT_EQ(run.exit_code, 1);
  const host::Json finding = run.json().at("findings").at(0);
  EXPECT_THAT(finding.at("what").get<std::string>(), HasSubstr("wrong baud rate"));
  EXPECT_THAT(finding.at("cure").get<std::string>(), HasSubstr("baud = 115200"));
}

TEST_F(Doctor, AChecksumStorm) {
  const TalkingLidar lidar{lidar_bytes(), 230'400, 2};
  const ToolRun run = run_tool(folder, {"doctor", "--lidar", lidar.path()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("checksum storm"));
}

TEST_F(Doctor, AnImuWhereTheLidarIs) {
  const TalkingLidar lidar{lidar_bytes(), 230'400};
  const ToolRun run = run_tool(folder, {"doctor", "--imu", lidar.path()});
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.out, HasSubstr("no packets of the IMU"));
}

TEST_F(Doctor, ANodeThatIsMissingAndABusThatIsNotThere) {
  folder.write("five.toml", "[wheels]\nleft_id = 5\n");
  const ToolRun none = run_tool(folder, {"doctor", "--can", "socket:bus"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_THAT(none.out, HasSubstr("no such interface"));
  // the vehicle lives as long as the shell waits for the doctor
  const std::string tool = test::quoted(PICOLO_TOOL);
  const std::string line = "cd " + test::quoted(folder.path().string()) + "; " + tool +
                           " simulate --can socket:bus --seconds 20 & vehicle=$!; "
                           "for i in $(seq 100); do test -S bus && break; sleep 0.05; done; " +
                           tool + " doctor --can socket:bus --config five.toml > doctor.out; " +
                           "kill $vehicle; wait $vehicle";
  static_cast<void>(std::system(line.c_str()));  // NOLINT(concurrency-mt-unsafe,cert-env33-c)
  const std::string out = test::content_of(folder.path() / "doctor.out");
  EXPECT_THAT(out, HasSubstr("the bus works"));
  EXPECT_THAT(out, HasSubstr("node 2 is there"));
  EXPECT_THAT(out, HasSubstr("no node 5"));
}

TEST_F(Doctor, WithoutAnythingToLookAtItSaysWhatToGive) {
  EXPECT_EQ(run_tool(folder, {"doctor"}).exit_code, 2);
}

}  // namespace
}  // namespace picolo
