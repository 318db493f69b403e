// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// A commander on the bus of a live controller: reads the tick from PicoloHealth, sends a command,
// sees it act.

#include <gtest/gtest.h>
#include <linux/can.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <string>

#include "picolo/controller/command_gate.hpp"
#include "picolo/linux/file_descriptor.hpp"
#include "process.hpp"

namespace picolo {
namespace {

using test::TemporaryFolder;
constexpr std::uint16_t kBase = 0x110;

/// The other end of --can socket:PATH.
class Commander {
 public:
  explicit Commander(const std::string& path) : listener_(::socket(AF_UNIX, SOCK_SEQPACKET, 0)) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
    const void* any = &address;
    if (::bind(listener_.get(), static_cast<const sockaddr*>(any), sizeof address) != 0) { return; }
    static_cast<void>(::listen(listener_.get(), 1));
  }
  bool meet() {
    if (!readable(listener_.get())) { return false; }
    line_ = FileDescriptor{::accept(listener_.get(), nullptr, nullptr)};
    return line_.is_open();
  }
  /// The values of the next frame of that message within some seconds.
  std::optional<CanValues> next(const CanMessage& message) {
    for (int i = 0; i < 20'000 && readable(line_.get()); ++i) {
      can_frame raw{};
      if (::recv(line_.get(), &raw, sizeof raw, 0) <= 0) { return std::nullopt; }
      CanFrame frame{.id = raw.can_id, .length = raw.can_dlc};
      std::copy(std::begin(raw.data), std::end(raw.data), frame.data.begin());
      const auto values = decode(message, kBase, frame);
      if (values) { return *values; }
    }
    return std::nullopt;
  }
  void send(const CanFrame& frame) {
    can_frame raw{};
    raw.can_id = frame.id;
    raw.can_dlc = frame.length;
    std::copy(frame.data.begin(), frame.data.end(), std::begin(raw.data));
    static_cast<void>(::send(line_.get(), &raw, sizeof raw, MSG_NOSIGNAL));
  }
  /// The command with the newest tick; what the controller answered.
  std::optional<CommandResult> ask(Command command) {
    const auto health = next(can_table::kHealth);
    if (!health) { return std::nullopt; }
    command.tick = static_cast<std::uint8_t>(health->raw[3]);
    send(encode_command(kBase, command));
    const auto reply = next(can_table::kReply);
    if (!reply) { return std::nullopt; }
    return static_cast<CommandResult>(reply->raw[2]);
  }

 private:
  static bool readable(int fd) {
    pollfd wait{.fd = fd, .events = POLLIN, .revents = 0};
    return ::poll(&wait, 1, 30'000) == 1;
  }
  FileDescriptor listener_;
  FileDescriptor line_;
};

TEST(LiveCommands, ActOnARunningController) {
  const TemporaryFolder folder;
  Commander commander{folder.file("bus")};
  test::Process run{folder,
                    "run",
                    {"run", "--can", "socket:bus", "--lidar", "lidar", "--imu", "imu", "--store",
                     "store.bin", "--record", "rec", "--json"}};
  ASSERT_TRUE(commander.meet()) << run.err();
  EXPECT_EQ(
      commander.ask({.kind = CommandKind::set_pose, .counter = 1, .map_T_base = {3.0, -1.5, 0.5}}),
      CommandResult::done);
  const auto pose = commander.next(can_table::kPose);
  ASSERT_TRUE(pose);
  EXPECT_NEAR(to_value(can_table::kPoseSignals[0], pose->raw[0]), 3.0, 0.001);
  EXPECT_NEAR(to_value(can_table::kPoseSignals[1], pose->raw[1]), -1.5, 0.001);
  EXPECT_NEAR(to_value(can_table::kPoseSignals[2], pose->raw[2]), 0.5, 0.001);
  EXPECT_EQ(commander.ask({.kind = CommandKind::set_pose, .counter = 1}), CommandResult::repeated);
  EXPECT_EQ(commander.ask({.kind = CommandKind::set_mode, .counter = 2, .detail = 1}),
            CommandResult::done);
  const auto health = commander.next(can_table::kHealth);
  ASSERT_TRUE(health);
  EXPECT_EQ(health->raw[2], static_cast<int>(OperatingMode::localising));
  EXPECT_EQ(commander.ask({.kind = CommandKind::save_map, .counter = 3}), CommandResult::started);
  const auto saved = commander.next(can_table::kReply);
  ASSERT_TRUE(saved);
  EXPECT_EQ(static_cast<CommandResult>(saved->raw[2]), CommandResult::done) << "an empty map, kept";
  EXPECT_EQ(commander.ask({.kind = CommandKind::start_calibration, .counter = 4}),
            CommandResult::done);
  EXPECT_TRUE(commander.next(can_table::kCalibration)) << "its progress is told";
  EXPECT_EQ(commander.ask({.kind = CommandKind::abort_calibration, .counter = 5}),
            CommandResult::done);
  EXPECT_EQ(run.stop(SIGTERM), 0) << run.err();
  const host::Json json = host::Json::parse(run.out());
  EXPECT_EQ(json.at("commands_accepted"), 5);

  const test::ToolRun replay = run_tool(folder, {"replay", "rec", "--out", "again", "--json"});
  EXPECT_EQ(replay.json().at("pose_hash"), json.at("pose_hash")) << "commands replay as well";
  EXPECT_EQ(replay.json().at("differences"), 0);
}

}  // namespace
}  // namespace picolo
