// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The installed composition: devices in, pose out, on the cyclic executive. The demo, the tool,
/// the board images and the examples all instantiate this class.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "picolo/controller/command_desk.hpp"
#include "picolo/controller/controller_config.hpp"
#include "picolo/controller/devices.hpp"
#include "picolo/controller/map_store.hpp"
#include "picolo/controller/pipeline.hpp"
#include "picolo/controller/pose_composer.hpp"
#include "picolo/controller/reporter.hpp"
#include "picolo/controller/services.hpp"
#include "picolo/controller/supervisor.hpp"
#include "picolo/core/fixed_vector.hpp"
#include "picolo/core/ring_buffer.hpp"
#include "picolo/executive/executive.hpp"
#include "picolo/localisation/event_ring.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::inline v0 {

/// Never reset.
struct ControllerCounters {
  std::uint32_t can_frames = 0;      ///< received
  std::uint32_t foreign_frames = 0;  ///< of these, meant for nobody here
  std::uint32_t ticks = 0;           ///< complete samples of the wheels
  std::uint32_t ticks_lost = 0;      ///< more than kMaxTicks in one frame
  std::uint32_t readings = 0;        ///< beams of the lidar
  std::uint32_t imu_samples = 0;
};

/// All memory inside (see the profile), none from the heap; keep it in static storage. `start`,
/// then `run_frame` whenever `next_frame` has come: by an absolute-time sleep, a hardware timer, or
/// a simulated clock. Never blocks. Context: one, the cycle; `read_pose` from any.
template <Profile P, WheelDevice Wheels, LidarDevice Lidar, ImuDevice Imu>
class Controller {
 public:
  static constexpr std::size_t kMaxTicks = 8;
  static constexpr std::size_t kMaxReadings = 48;
  static constexpr std::size_t kMaxImuSamples = 8;
  static constexpr std::size_t kSerialSlices = 4;  ///< of the byte bound: keeps the buffers small

  /// Everything referred to outlives the controller. `events` may lie in memory that survives a
  /// reset. `services`: other wheels than configured, what commands may ask for beyond the
  /// controller itself.
  Controller(const Board& board, Wheels& wheels, Lidar& lidar, Imu& imu, EventRing& events,
             const ControllerConfig& config, const ControllerServices& services = {})
      : config_(config.valid() ? config : ControllerConfig{}),
        configuration_valid_(config.valid()),
        board_(board),
        wheels_(wheels),
        lidar_(lidar),
        imu_(imu),
        events_(events),
        localiser_(config_.localiser),
        pipeline_(config_, {first_sweep_, second_sweep_, x_m_, y_m_}, localiser_.core(),
                  services.drive),
        composer_(config_),
        supervisor_(config_.health, config_.trust, events),
        reporter_(config_.frames_out, board.can),
        desk_(config_.frames_out, usable(services), pipeline_, composer_, supervisor_, reporter_),
        executive_(config_.cycle, controller_tasks(config_.work, config_.budgets, config_.policies),
                   board.clock, board.cycle_counter, board.watchdog) {}
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;
  ~Controller() = default;

  /// The first frame is released at once. `invalid_argument`: the configuration; the pose says
  /// fault then, and nothing runs.
  Status start() {
    const Timestamp now = board_.clock.now();
    supervisor_.start(now, events_.attach());
    if (localiser_.core().localises_only()) { supervisor_.distrust(); }
    composer_.start(now);
    const Status status = configuration_valid_ ? executive_.start() : Status::invalid_argument;
    if (status != Status::ok) { supervisor_.refuse_configuration(); }
    publish(now);
    return status;
  }
  /// Before `start`: the newest map of the store becomes the one in which sweeps are localised,
  /// from `start_map_T_base` of the configuration on; it is not changed any more. Status as
  /// MapStore::begin_load and step; after a failure the controller builds its own map, as without
  /// this call. Cost: reads and decodes the whole map, then the field of every tile, as one piece.
  Status load_map(MapStore& store) {
    LocaliserCore& localiser = localiser_.core();
    Status status = store.begin_load(localiser.restorable_map());
    if (is_ok(status)) {
      do { status = store.step(1); } while (status == Status::not_ready);
    }
    return is_ok(status) ? localiser.localise_in_restored_map() : status;
  }
  [[nodiscard]] Timestamp next_frame() const { return executive_.next_release(); }
  /// Runs the tasks of the frame that is due. `not_ready`: none is.
  Status run_frame() { return executive_.run_frame(*this); }
  /// The same, with an observer of each task's length.
  template <TaskObserver Observer>
  Status run_frame(Observer& observer) {
    return executive_.run_frame(*this, observer);
  }

  /// The newest published pose. False before `start`. Wait-free, from any context.
  [[nodiscard]] bool read_pose(PoseEstimate& estimate) const { return published_.read(estimate); }

  // The rest is for the cycle's own context.
  [[nodiscard]] const PoseEstimate& estimate() const { return estimate_; }
  [[nodiscard]] const FrameInfo& last_frame() const { return frame_; }
  [[nodiscard]] const Schedule& schedule() const { return executive_.schedule(); }
  [[nodiscard]] const Pipeline& pipeline() const { return pipeline_; }
  [[nodiscard]] const Supervisor& supervisor() const { return supervisor_; }
  [[nodiscard]] const ControllerCounters& counters() const { return counters_; }
  [[nodiscard]] const Reporter& reporter() const { return reporter_; }
  [[nodiscard]] const CommandDesk& commands() const { return desk_; }
  [[nodiscard]] const ControllerConfig& config() const { return config_; }

  /// For the executive: does the work of one task. Always passes its checkpoint; a device that is
  /// silent or gone is the supervisor's matter, not the watchdog's.
  bool run(std::size_t task, std::uint32_t work_bound, const FrameInfo& frame) {
    frame_ = frame;
    switch (static_cast<ControllerTask>(task)) {
      case ControllerTask::can:
        stage_at_start_ = pipeline_.stage();
        drain_can(work_bound);
        break;
      case ControllerTask::serial: drain_serial(work_bound); break;
      case ControllerTask::odometry: integrate(); break;
      case ControllerTask::undistort: undistort(work_bound); break;
      case ControllerTask::match:
        if (may_work(PipelineStage::matching)) { judge(pipeline_.match(work_bound)); }
        break;
      case ControllerTask::map:
        if (may_work(PipelineStage::mapping)) { pipeline_.map(work_bound); }
        break;
      case ControllerTask::background: in_background(work_bound); break;
      case ControllerTask::report: report(); break;
    }
    return true;
  }

 private:
  /// The calibration finds the sizes of two wheels on an axle, and no others.
  static ControllerServices usable(ControllerServices services) {
    if (services.drive != nullptr) { services.calibration = nullptr; }
    return services;
  }

  void drain_can(std::uint32_t max_frames) {
    Status status = Status::ok;
    for (std::uint32_t i = 0; i < max_frames; ++i) {
      const Result<CanFrame> received = board_.can.receive();
      status = received.status();
      if (!received) { break; }
      ++counters_.can_frames;
      if (!wheels_.consume(*received)) {
        if (!desk_.consume(*received, frame_.start)) { ++counters_.foreign_frames; }
        continue;
      }
      take_ticks();
    }
    supervisor_.line(DeviceIndex::wheels, status, frame_.start);
    (void)wheels_.service(frame_.start);  // what the bus refused is tried again
    take_ticks();                         // of encoders that are not on the bus
  }

  void take_ticks() {
    const Result<WheelTicks> ticks = wheels_.take();
    if (ticks) { keep(*ticks); }
  }

  void keep(const WheelTicks& ticks) {
    supervisor_.heard(DeviceIndex::wheels, ticks.stamp);
    ++counters_.ticks;
    if (!ticks_.push_back(ticks)) { ++counters_.ticks_lost; }
    if (calibration() != nullptr) { calibration()->add(ticks); }
  }

  void drain_serial(std::uint32_t max_bytes) {
    const std::size_t slice = std::max<std::size_t>(1, max_bytes / kSerialSlices);
    for (std::size_t i = 0; i < kSerialSlices && drain_lidar(slice); ++i) {}
    for (std::size_t i = 0; i < kSerialSlices && drain_imu(slice); ++i) {}
    serve(lidar_);
    serve(imu_);
  }

  // Devices that must be asked for their data are given the time to ask.
  template <typename Device>
  void serve(Device& device) {
    if constexpr (requires { device.service(frame_.start); }) {
      (void)device.service(frame_.start);  // what the line refused is tried again
    }
  }

  // True while the line had something to say.
  bool drain_lidar(std::size_t max_bytes) {
    const Result<std::size_t> count = lidar_.poll(max_bytes, readings_);
    supervisor_.line(DeviceIndex::lidar, count.status(), frame_.start);
    for (std::size_t i = 0; i < count.value_or(0); ++i) { pipeline_.add(readings_[i]); }
    counters_.readings += static_cast<std::uint32_t>(count.value_or(0));
    return static_cast<bool>(count);
  }

  bool drain_imu(std::size_t max_bytes) {
    const Result<std::size_t> count = imu_.poll(max_bytes, samples_);
    supervisor_.line(DeviceIndex::imu, count.status(), frame_.start);
    for (std::size_t i = 0; i < count.value_or(0); ++i) {
      supervisor_.heard(DeviceIndex::imu, samples_[i].stamp);
      pipeline_.add(samples_[i]);
      if (calibration() != nullptr) { calibration()->add(samples_[i]); }
    }
    counters_.imu_samples += static_cast<std::uint32_t>(count.value_or(0));
    return static_cast<bool>(count);
  }

  // After both drains, so that the gyro's samples are in before the wheels ask for them.
  void integrate() {
    for (const WheelTicks& ticks : ticks_) { pipeline_.add(ticks); }
    ticks_.clear();
    pipeline_.coast(frame_.start);
    supervisor_.heard(DeviceIndex::lidar, pipeline_.last_sweep_end());
    supervisor_.turns(pipeline_.turns_disagree());
    supervisor_.doubted(frame_.start, pipeline_.doubts());
    supervisor_.tilted(pipeline_.tilted());
    const LocaliserCore& localiser = localiser_.core();
    supervisor_.searching(pipeline_.searching(), localiser.unverified(), localiser.ambiguous());
    pipeline_.doubt(supervisor_.unproven());
    pipeline_.hold_map(supervisor_.doubts_pose() || desk_.mode() == OperatingMode::localising);
    publish(frame_.start);
  }

  void publish(Timestamp now) {
    estimate_ =
        composer_.compose(now, pipeline_.newest_pose(now), pipeline_.odometry().base_twist());
    supervisor_.turn_unverified(composer_.turn_unverified(pipeline_.odometry().turns_by_gyro()));
    // Judged before each publication: what is wrong must not be told as tracking even a few times.
    supervisor_.update(now, estimate_, executive_.schedule());
    estimate_.state = supervisor_.state();
    estimate_.reason = supervisor_.reason();
    published_.publish(estimate_);
  }

  void undistort(std::uint32_t max_returns) {
    const bool ready = pipeline_.undistort(max_returns);
    if (ready && calibration() != nullptr) { calibration()->add(pipeline_.sweep()); }
  }

  // A stage that was entered in this frame waits for the next one, where only one may work.
  [[nodiscard]] bool may_work(PipelineStage stage) const {
    return !config_.work.one_stage_a_frame || stage_at_start_ == stage;
  }

  void judge(bool match_ended) {
    if (!match_ended) { return; }
    const MatchVerdict& verdict = pipeline_.verdict();
    if (verdict.accepted) { composer_.correct(verdict, pipeline_.newest_pose(frame_.start)); }
    const PoseCorrection correction = verdict.accepted ? composer_.correction() : PoseCorrection{};
    const bool leapt = supervisor_.matched(verdict, correction);
    if (leapt && !localiser_.core().unverified()) { pipeline_.verify(); }
    if (correction.jumped) {
      supervisor_.event(frame_.start, EventCode::pose_jump, composer_.jump_mm());
    }
  }

  // Search and services by turns, where only one may work.
  void in_background(std::uint32_t max_slices) {
    const bool one = config_.work.one_stage_a_frame && pipeline_.searching() && desk_.serving();
    serves_ = !one || !serves_;
    if (!one || !serves_) { judge(pipeline_.search(max_slices)); }
    if (serves_) { desk_.work(frame_.start); }
  }

  void report() {
    const PipelineCounters& sweeps = pipeline_.counters();
    supervisor_.sweeps(frame_.start, sweeps.sweeps_replaced + pipeline_.sweep_counters().replaced,
                       sweeps.sweeps_uncovered + sweeps.sweeps_refused);
    reporter_.report({.now = frame_.start,
                      .estimate = estimate_,
                      .mode = desk_.mode(),
                      .events = supervisor_.events(),
                      .counters = counter_values(),
                      .calibration = calibration()});
  }

  [[nodiscard]] CalibrationService* calibration() const { return desk_.services().calibration; }

  // In the order of CounterIndex.
  [[nodiscard]] CounterValues counter_values() const {
    const PipelineCounters& sweeps = pipeline_.counters();
    const LocaliserCounters& matches = pipeline_.localiser().counters();
    const CommandCounters& commands = desk_.counters();
    const CanStatus bus = board_.can.status();
    return {counters_.can_frames,
            counters_.foreign_frames,
            counters_.ticks,
            counters_.ticks_lost,
            counters_.readings,
            counters_.imu_samples,
            reporter_.sent(),
            reporter_.refused(),
            desk_.impersonated(),
            sweeps.sweeps_taken,
            sweeps.sweeps_replaced + pipeline_.sweep_counters().replaced,
            sweeps.sweeps_uncovered,
            sweeps.sweeps_refused,
            matches.matched,
            matches.rejected,
            matches.searched,
            schedule().overruns(),
            schedule().frame_counters().slipped,
            supervisor_.events().total(),
            commands.accepted,
            commands.corrupt,
            commands.repeated,
            commands.stale,
            commands.refused,
            bus.rx_lost,
            bus.error_frames,
            bus.restarts};
  }

  ControllerConfig config_;  // the default one when the given one is refused
  bool configuration_valid_;
  Board board_;
  Wheels& wheels_;
  Lidar& lidar_;
  Imu& imu_;
  EventRing& events_;
  std::array<RangeReturn, P::kReturns> first_sweep_{};
  std::array<RangeReturn, P::kReturns> second_sweep_{};
  std::array<float, P::kReturns> x_m_{};
  std::array<float, P::kReturns> y_m_{};
  std::array<RangeReading, kMaxReadings> readings_{};
  std::array<ImuSample, kMaxImuSamples> samples_{};
  FixedVector<WheelTicks, kMaxTicks> ticks_{};
  Localiser<P> localiser_;
  Pipeline pipeline_;
  PoseComposer composer_;
  Supervisor supervisor_;
  Reporter reporter_;
  CommandDesk desk_;
  Executive<Clock, CycleCounter, Watchdog, kControllerTasks> executive_;
  FrameInfo frame_{};
  PipelineStage stage_at_start_ = PipelineStage::waiting;  // of the frame
  bool serves_ = false;                                    // the background did, last
  PoseEstimate estimate_{};
  LatestValue<PoseEstimate> published_{};
  ControllerCounters counters_{};
};

}  // namespace picolo::inline v0
