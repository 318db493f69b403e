// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "lockstep_run.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <future>
#include <memory>

#include "picolo/simulated/board_config.hpp"
#include "picolo/simulated/lockstep_controller.hpp"
#include "picolo/simulated/log_config.hpp"

namespace picolo::target {
namespace {

/// A folder with two pipes, gone at the end.
class Pipes {
 public:
  Pipes() {
    std::string name = (std::filesystem::temp_directory_path() / "picolo-XXXXXX").string();
    folder_ = ::mkdtemp(name.data()) == nullptr ? "" : name;
    ::mkfifo(packets().c_str(), 0600);
    ::mkfifo(replies().c_str(), 0600);
    // Both ends here, so that opening never waits for an image that does not start.
    packets_ = ::open(packets().c_str(), O_RDWR | O_CLOEXEC);
    replies_ = ::open(replies().c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  Pipes(const Pipes&) = delete;
  Pipes& operator=(const Pipes&) = delete;
  ~Pipes() {
    close_packets();
    ::close(replies_);
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  [[nodiscard]] std::string packets() const { return folder_ + "/packets"; }
  [[nodiscard]] std::string replies() const { return folder_ + "/replies"; }

  bool write(ByteView bytes) const {
    return ::write(packets_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  }
  /// The image sees the end of its input then.
  void close_packets() {
    if (packets_ >= 0) { ::close(packets_); }
    packets_ = -1;
  }
  /// False when the image ended.
  bool read(std::span<std::uint8_t> bytes, const std::future<Outcome>& image) const {
    std::size_t size = 0;
    while (size < bytes.size()) {
      const ssize_t count = ::read(replies_, bytes.data() + size, bytes.size() - size);
      if (count > 0) {
        size += static_cast<std::size_t>(count);
        continue;
      }
      if (image.wait_for(std::chrono::seconds{0}) == std::future_status::ready) { return false; }
      ::usleep(50);
    }
    return true;
  }

 private:
  std::string folder_;
  int packets_ = -1;
  int replies_ = -1;
};

class StandingCycles final : public CycleCounter {
 public:
  [[nodiscard]] std::uint32_t cycles() override { return 0; }
  [[nodiscard]] std::uint32_t cycles_per_us() const override { return 1; }
};

/// What the wires of the drive brought since the last frame.
ByteView drain(Drive& drive, lockstep::PacketWriter& packet) {
  while (const Result<CanFrame> frame = drive.can().receive()) { packet.add(*frame); }
  std::array<std::uint8_t, 1> byte{};
  while (const Result<SerialRead> got = drive.lidar_port().read(byte)) {
    packet.add_lidar(byte[0], got->last_byte_stamp);
  }
  sim::SimSerialPort* const imu = drive.imu_port();
  while (imu != nullptr) {
    const Result<SerialRead> got = imu->read(byte);
    if (!got) { break; }
    packet.add_imu(byte[0], got->last_byte_stamp);
  }
  return packet.finish();
}

using Robot = LockstepController<RoomProfile>;

/// One frame on both sides; false when the image is gone.
bool frame_on_both(const Pipes& pipes, const std::future<Outcome>& image, ByteView packet,
                   Robot& twin, LockstepRun& run) {
  if (!pipes.write(packet)) { return false; }
  TaskTicks unused;
  Status status = twin.take(packet);
  if (is_ok(status)) { status = twin.run_frame(unused); }
  std::array<std::uint8_t, Robot::kMaxReply> wanted{};
  const std::size_t comparable = twin.reply(status, wanted);

  std::array<std::uint8_t, Robot::kMaxReply> reply{};
  if (!pipes.read(std::span{reply}.first(2), image)) { return false; }
  const std::size_t size = load_u16_le(reply, 0);
  if (size > reply.size() || !pipes.read(std::span{reply}.subspan(2, size - 2), image)) {
    return false;
  }
  const std::size_t measures = 4 * (kControllerTasks + 1);
  const bool equal =
      size == 2 + comparable + measures &&
      std::equal(wanted.begin(), wanted.begin() + static_cast<std::ptrdiff_t>(comparable),
                 reply.begin() + 2);
  if (!equal && run.unequal++ == 0) { run.first_unequal = run.frames; }
  std::vector<std::uint32_t> ticks;
  for (std::size_t task = 0; task < kControllerTasks; ++task) {
    ticks.push_back(load_u32_le(reply, size - measures + 4 * task));
  }
  run.ticks.push_back(ticks);
  run.deepest_stack_bytes = std::max(run.deepest_stack_bytes, load_u32_le(reply, size - 4));
  run.pose_frames += static_cast<std::uint32_t>(twin.board().can().sent().size());
  ++run.frames;
  return true;
}

/// What the twin did in the frames, for the table of work.
class Witness {
 public:
  explicit Witness(const Pipeline& pipeline) : pipeline_(pipeline) {}
  /// To be called after each frame; `calibrates`: the routine had a slice of it.
  void look(bool calibrates, LockstepRun& run) {
    const LocaliserCounters& counters = pipeline_.localiser().counters();
    const bool searching = pipeline_.searching();
    const bool anywhere = counters.searched_anywhere != anywhere_;
    run.background.push_back(!searching && !searching_
                                 ? (calibrates ? BackgroundWork::calibration : BackgroundWork::none)
                             : anywhere ? BackgroundWork::relocalisation
                                        : BackgroundWork::search);
    searching_ = searching;
    const PipelineStage stage = pipeline_.stage();
    if (stage == PipelineStage::waiting && stage_ != PipelineStage::waiting) {
      const SweepWork work = work_so_far(pipeline_.localiser());
      const UndistortedSweep& sweep = pipeline_.sweep();
      run.sweeps.push_back(
          {.last_frame = run.frames - 1,
           .searched = anywhere || counters.searched != searched_,
           .work = work_between(work_, work,
                                static_cast<double>(sweep.points.size() + sweep.invalid_returns))});
      work_ = work;
      searched_ = counters.searched;
      anywhere_ = counters.searched_anywhere;
    }
    stage_ = stage;
  }

 private:
  const Pipeline& pipeline_;
  PipelineStage stage_ = PipelineStage::waiting;
  bool searching_ = false;
  std::uint32_t searched_ = 0;
  std::uint32_t anywhere_ = 0;
  SweepWork work_{};
};

}  // namespace

LockstepRun run_lockstep(const Platform& platform, Drive& drive, bool icount, bool calibrates) {
  LockstepRun run;
  Pipes pipes;
  auto image = std::async(std::launch::async, [&] {
    return target::run(platform, calibrates ? "calibrating" : "lockstep",
                       {pipes.packets(), pipes.replies(), drive.recorded() ? "log" : "live"},
                       icount ? "-icount shift=6" : "");
  });
  StandingCycles cycles;
  const ControllerConfig installed = board_config(platform.software_doubles());
  const ControllerConfig config = drive.recorded() ? on_a_log(installed) : installed;
  BoardCalibration calibration{board_calibration(config, platform.software_doubles())};
  const auto twin = std::make_unique<Robot>(
      cycles, config,
      ControllerServices{.calibration = calibrates ? &calibration.core() : nullptr});
  Witness witness{twin->controller().pipeline()};
  Timestamp next = drive.now();
  while (!drive.over()) {
    drive.advance_to(next);
    lockstep::PacketWriter packet{next};
    const bool calibrated = calibration.core().routine().running();
    if (!frame_on_both(pipes, image, drain(drive, packet), *twin, run)) {
      run.trouble = "the image ended in frame " + std::to_string(run.frames);
      break;
    }
    for (const CanFrame& frame : twin->board().can().sent()) { (void)drive.can().transmit(frame); }
    witness.look(calibrated, run);
    next = twin->controller().next_frame();
  }
  pipes.close_packets();
  const Outcome outcome = image.get();
  if (run.trouble.empty() && outcome.status != 0) { run.trouble = "the image's status is not 0"; }
  if (!run.trouble.empty()) { run.trouble += ": " + outcome.output; }
  const PoseEstimate& estimate = twin->controller().estimate();
  run.matches = estimate.matches;
  run.replaced = twin->controller().pipeline().counters().sweeps_replaced +
                 twin->controller().pipeline().sweep_counters().replaced;
  run.calibration = calibration.core().progress();
  if (const std::optional<Pose2d> truth = drive.true_map_T_base(estimate.stamp)) {
    run.final_error_m =
        std::hypot(estimate.map_T_base.x_m - truth->x_m, estimate.map_T_base.y_m - truth->y_m);
  }
  return run;
}

}  // namespace picolo::target
