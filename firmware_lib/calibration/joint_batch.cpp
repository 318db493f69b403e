// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/calibration/joint_batch.hpp"

#include "drive_information.hpp"
#include "joint_system.hpp"
#include "picolo/calibration/order_statistic.hpp"
#include "picolo/core/arithmetic.hpp"
#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0 {
namespace {

/// One rejection: the estimate that errors were taken against, and their limits.
struct Round {
  DriveParameters drive{};
  double translation_m = 0.0;
  double rotation_rad = 0.0;

  [[nodiscard]] bool keeps(const MotionSample& sample) const {
    const Pose2d error = motion_residual(drive, sample);
    return !(hypotenuse(error.x_m, error.y_m) > translation_m) &&
           !(magnitude(error.theta_rad) > rotation_rad);
  }
};

/// The procedure and its only state: what each rejection was, so that a pass can tell who is still
/// in.
class Procedure {
 public:
  Procedure(SampleSource<MotionSample>& source, const JointBatchConfig& config)
      : source_(source), config_(config) {}

  Status run(JointReport& report) {
    MotionCheck check;
    for_survivors(0, [&](const MotionSample& sample) { check.add(sample); });
    report.samples = check.samples();
    report.refusal = check.judge(config_.needs);
    for (int round = 0; round <= config_.outlier_rounds; ++round) {
      if (!is_ok(estimate(report))) {
        return refuse(report, RefusalReason::numerically_singular, Parameter::track_width);
      }
      if (config_.outlier_rounds > 0) {
        reject(report.drive, report.used);
      }  // the last one only for the covariance
    }
    return finish(report);
  }

 private:
  static Status refuse(JointReport& report, RefusalReason reason, Parameter parameter) {
    if (!report.refusal) { report.refusal = {reason, parameter}; }
    return Status::degenerate;
  }

  template <typename Visit>
  void for_survivors(int rounds, Visit visit) {
    MotionSample sample;
    source_.rewind();
    while (source_.next(sample)) {
      bool kept = true;
      for (int k = 0; kept && k < rounds; ++k) {
        kept = rounds_[static_cast<std::size_t>(k)].keeps(sample);
      }
      if (kept) { visit(sample); }
    }
  }

  /// J21, J22 from rotation, then b, l_x, l_y, yaw.
  Status estimate(JointReport& report) {
    MotionCheck rotation;
    for_survivors(done_, [&](const MotionSample& sample) { rotation.add(sample); });
    report.used = rotation.samples();
    if (!is_ok(rotation.rotation_gain(report.gain))) { return Status::degenerate; }
    JointMatrix m{};
    for_survivors(done_,
                  [&](const MotionSample& sample) { add_joint_rows(m, report.gain, sample); });
    return solve_joint(m, report.gain, report.drive);
  }

  void reject(const DriveParameters& drive, std::uint64_t count) {
    OrderStatistic translation;
    OrderStatistic rotation;
    const auto index = static_cast<std::uint64_t>(
        round_to_i64(config_.quantile * static_cast<double>(count), 0, INT64_C(1) << 62));
    translation.select(index);
    rotation.select(index);
    while (translation.searching() || rotation.searching()) {
      for_survivors(done_, [&](const MotionSample& sample) {
        const Pose2d error = motion_residual(drive, sample);
        translation.offer(hypotenuse(error.x_m, error.y_m));
        rotation.offer(magnitude(error.theta_rad));
      });
      translation.end_pass();
      rotation.end_pass();
    }
    rounds_[static_cast<std::size_t>(done_)] = {drive, translation.value(), rotation.value()};
    ++done_;
  }

  Pose2d noise_of(const DriveParameters& drive, int rounds) {
    ResidualMoments moments;
    for_survivors(rounds,
                  [&](const MotionSample& sample) { moments.add(motion_residual(drive, sample)); });
    return moments.standard_deviation();
  }

  Status finish(JointReport& report) {
    const Pose2d published = noise_of(report.drive, done_ > 0 ? 1 : 0);
    report.noise = noise_of(report.drive, done_);
    DriveMatrix by_published{};
    DriveMatrix by_inliers{};
    for_survivors(done_, [&](const MotionSample& sample) {
      const DriveJacobian jacobian = lidar_motion_jacobian(report.drive, sample);
      add_information(by_published, jacobian, published);
      add_information(by_inliers, jacobian, report.noise);
    });
    if (!is_ok(covariance_of(by_inliers, report.inlier_covariance, report.condition)) ||
        !is_ok(covariance_of(by_published, report.covariance, report.condition))) {
      return refuse(report, RefusalReason::numerically_singular, Parameter::lidar_yaw);
    }
    const auto& c = report.inlier_covariance;
    const auto too_wide = [&](std::size_t k, double limit) { return !(c[7 * k] <= limit * limit); };
    if (too_wide(2, config_.max_relative_std * report.drive.track_m)) {
      return refuse(report, RefusalReason::too_little_data, Parameter::track_width);
    }
    if (too_wide(0, config_.max_relative_std * report.drive.radius_left_m)) {
      return refuse(report, RefusalReason::too_little_data, Parameter::wheel_radius_left);
    }
    if (too_wide(1, config_.max_relative_std * report.drive.radius_right_m)) {
      return refuse(report, RefusalReason::too_little_data, Parameter::wheel_radius_right);
    }
    if (too_wide(5, config_.max_yaw_std_rad)) {
      return refuse(report, RefusalReason::no_translation, Parameter::lidar_yaw);
    }
    return report.refusal ? Status::degenerate : Status::ok;
  }

  SampleSource<MotionSample>& source_;
  const JointBatchConfig& config_;
  std::array<Round, JointBatchConfig::kMaxRounds + 1> rounds_{};
  int done_ = 0;
};

}  // namespace

Status calibrate_joint(SampleSource<MotionSample>& source, const JointBatchConfig& config,
                       JointReport& report) {
  report = JointReport{};
  if (!config.valid()) { return Status::invalid_argument; }
  return Procedure{source, config}.run(report);
}

}  // namespace picolo::inline v0
