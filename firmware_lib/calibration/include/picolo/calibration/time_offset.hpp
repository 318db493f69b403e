// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The offset between the clock of the wheels and that of a second sensor which sees rotation
/// (lidar motion or gyro), from the correlation of both over a bounded window of lags. Online,
/// single pass, constant memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/calibration/parameter.hpp"
#include "picolo/core/status.hpp"

namespace picolo::inline v0 {

struct TimeOffsetConfig {
  double max_offset_s = 0.5;  ///< lags from -max to +max
  std::uint64_t min_intervals = 50;
  double max_std_s = 0.02;  ///< above: refused
  double min_explained =
      0.3;  ///< share of the rotation that the wheels explain at the best lag; below: refused
  Parameter parameter = Parameter::time_offset;  ///< named in refusals: time_offset or gyro_offset
  [[nodiscard]] constexpr bool valid() const {
    return max_offset_s > 0.0 && min_intervals >= 10 && max_std_s > 0.0 && min_explained >= 0.0 &&
           min_explained < 1.0;
  }
};

struct TimeOffsetReport {
  /// How much older the second sensor's data is than its stamp says: it was measured at stamp -
  /// offset on the wheels' clock.
  Estimate offset_s{};
  /// Found along with it: heading per radian of the left and the right wheel, and the second
  /// sensor's drift.
  double j21 = 0.0;
  double j22 = 0.0;
  double drift_radps = 0.0;
  double explained = 0.0;       ///< share of the rotation explained at the best lag
  double noise_rad = 0.0;       ///< of one interval
  std::uint64_t intervals = 0;  ///< used
  std::uint64_t rejected = 0;   ///< no lag explains them: slip, or a wrong match
  Refusal refusal{};
};

/// Cumulative angles of both wheels at one instant.
struct WheelAngles {
  double stamp_s = 0.0;
  double left_rad = 0.0;
  double right_rad = 0.0;
};

/// Normal equations of one lag: heading = J21 left + J22 right + drift dt.
struct LagSums {
  double ll = 0.0, lr = 0.0, rr = 0.0, lt = 0.0, rt = 0.0, ld = 0.0, rd = 0.0;
};

/// An interval of the second sensor that waits for the wheels to catch up.
struct RotationInterval {
  double begin_s = 0.0;
  double end_s = 0.0;
  double theta_rad = 0.0;
};

/// The logic behind `TimeOffset`, over storage it does not own. For each lag the wheels are
/// integrated over the shifted interval and regressed on the rotation seen; the residual as a
/// function of the lag is least at the offset, and its curvature says how well it is known. Gains
/// and drift are refitted at each lag, so neither needs to be calibrated before.
/// Cost: `add_wheels` and `add_rotation` O(lags log history) for each interval that can be served.
/// In a cycle: `offer_wheels`, `offer_rotation`, then `step` as long as there is time; all three
/// bounded. Context: one at a time.
class TimeOffsetCore {
 public:
  /// Precondition: lags.size() odd and >= 5; history.size() >= 4; waiting not empty.
  TimeOffsetCore(const TimeOffsetConfig& config, std::span<LagSums> lags,
                 std::span<WheelAngles> history, std::span<RotationInterval> waiting);

  /// `out_of_range`: not later than the newest; ignored. `invalid_argument`: not finite.
  Status add_wheels(const WheelAngles& angles);
  /// Rotation seen between two stamps of the second sensor. `full`: more intervals wait for wheels
  /// than there is room; dropped.
  Status add_rotation(double begin_s, double end_s, double theta_rad);
  /// As `add_wheels`, without work on intervals. `full`: one that is half served would lose its
  /// past; left out.
  Status offer_wheels(const WheelAngles& angles);
  /// As `add_rotation`, without work on intervals.
  Status offer_rotation(double begin_s, double end_s, double theta_rad);
  /// Works on at most `max_lags` lags of the oldest interval. False when nothing can be done. Cost:
  /// some 150 operations a lag; the first call of an interval judges it by the lags within 0.1 s.
  bool step(std::size_t max_lags);
  /// An interval is half served: `solve` waits for the rest of it.
  [[nodiscard]] bool busy() const { return open_; }
  /// Forgets wheels and intervals.
  void reset();
  /// The wheels at an instant of the history. `not_ready`: not reached yet; `out_of_range`:
  /// forgotten.
  Status wheels_at(double stamp_s, WheelAngles& angles) const;

  /// `degenerate` with a refusal when the data does not show the offset. Cost: a 3x3 solution for
  /// each lag; `solve_nearby` looks only around the best lag of the last full look (at most eight
  /// intervals ago) and costs seven of them or a few more.
  Status solve(TimeOffsetReport& report) const;
  Status solve_nearby(TimeOffsetReport& report) const;
  /// `solve_nearby` in slices of at most `max_fits` solutions, the last one of five more and some.
  /// False until the report is complete.
  void begin_solution();
  bool solve_slice(std::size_t max_fits, TimeOffsetReport& report);
  /// Intervals dropped because the wheels' history did not reach back to them, or because too many
  /// waited.
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  struct Fit {
    double squares = 0.0;
    double j21 = 0.0, j22 = 0.0, drift = 0.0;
  };
  /// Downhill from the lag of the last look, upwards first.
  struct Walk {
    std::size_t best = 0;
    Fit least{};
    bool begun = false;
    bool upwards = true;
    bool over = false;
  };
  void step_walk(Walk& walk) const;
  [[nodiscard]] double lag_s(std::size_t index) const;
  [[nodiscard]] const WheelAngles& by_age(std::size_t index) const;
  [[nodiscard]] WheelAngles at(double stamp_s) const;
  [[nodiscard]] Fit fit(std::size_t lag) const;
  [[nodiscard]] std::size_t best_lag(Fit& least) const;
  [[nodiscard]] bool is_outlier(const RotationInterval& interval);
  [[nodiscard]] Status solve_at(std::size_t best, const Fit& least, TimeOffsetReport& report) const;
  [[nodiscard]] bool open_next();
  void add_to_lag(std::size_t index);
  void close();

  TimeOffsetConfig config_;
  std::span<LagSums> lags_;
  std::span<WheelAngles> history_;
  std::span<RotationInterval> waiting_;
  std::size_t next_ = 0;
  std::size_t size_ = 0;
  std::size_t waiting_first_ = 0;
  std::size_t waiting_size_ = 0;
  double tt_ = 0.0, td_ = 0.0, dd_ = 0.0;
  std::uint64_t intervals_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint64_t rejected_ = 0;
  Fit gate_fit_{};
  std::size_t gate_lag_ = 0;
  double gate_explained_ = 0.0;
  double gate_median_ = 0.0;
  bool open_ = false;  // the oldest waiting interval has been added to lags before next_lag_
  std::size_t next_lag_ = 0;
  bool looking_ = false;  // in this pass each lag is fitted as well
  Fit looked_fit_{};
  std::size_t looked_lag_ = 0;
  Walk walk_{};  // of a solution in slices
};

/// Storage: 56 bytes a lag, 24 a wheel sample, 24 a waiting interval. History must span 2
/// max_offset and the longest interval: 1.2 s at 100 Hz is 128 samples.
template <std::size_t Lags, std::size_t History, std::size_t Waiting = 32>
class TimeOffset {
  static_assert(Lags % 2 == 1 && Lags >= 5 && History >= 4 && Waiting >= 1);

 public:
  explicit TimeOffset(const TimeOffsetConfig& config = {})
      : core_(config, lags_, history_, waiting_) {}
  TimeOffset(const TimeOffset&) = delete;
  TimeOffset& operator=(const TimeOffset&) = delete;
  ~TimeOffset() = default;
  [[nodiscard]] TimeOffsetCore& core() { return core_; }
  [[nodiscard]] const TimeOffsetCore& core() const { return core_; }

 private:
  std::array<LagSums, Lags> lags_{};
  std::array<WheelAngles, History> history_{};
  std::array<RotationInterval, Waiting> waiting_{};
  TimeOffsetCore core_;
};

}  // namespace picolo::inline v0
