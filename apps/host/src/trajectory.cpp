// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/trajectory.hpp"

#include <fmt/format.h>

#include <iterator>

#include "fields.hpp"
#include "picolo/core/math.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"

namespace picolo::host {

void write_tum(const std::filesystem::path& path, std::span<const TrajectoryPose> poses) {
  fmt::memory_buffer text;
  for (const auto& [stamp_s, pose] : poses) {
    const SinCos<double> half = sin_cos(0.5 * pose.theta_rad);
    fmt::format_to(std::back_inserter(text), "{:.6f} {:.9f} {:.9f} 0 0 0 {:.9f} {:.9f}\n", stamp_s,
                   pose.x_m, pose.y_m, half.sine, half.cosine);
  }
  write_file(path, {text.data(), text.size()});
}

void write_kitti(const std::filesystem::path& path, std::span<const TrajectoryPose> poses) {
  fmt::memory_buffer text;
  for (const auto& [stamp_s, pose] : poses) {
    const SinCos<double> yaw = sin_cos(pose.theta_rad);
    fmt::format_to(std::back_inserter(text),
                   "{:.9f} {:.9f} 0 {:.9f} {:.9f} {:.9f} 0 {:.9f} 0 0 1 0\n", yaw.cosine, -yaw.sine,
                   pose.x_m, yaw.sine, yaw.cosine, pose.y_m);
  }
  write_file(path, {text.data(), text.size()});
}

namespace {

TrajectoryPose parse_tum(const Fields& fields) {
  fields.expect_size(8, "a TUM pose");
  const double qx = fields.number(4, "qx");
  const double qy = fields.number(5, "qy");
  const double qz = fields.number(6, "qz");
  const double qw = fields.number(7, "qw");
  const double norm = qx * qx + qy * qy + qz * qz + qw * qw;
  if (!(norm > 0.5 && norm < 2.0)) {
    throw BadLine{fmt::format("quaternion of squared length {:.6g}, expected 1", norm)};
  }
  TrajectoryPose pose;
  pose.stamp_s = fields.number(0, "stamp");
  pose.pose = {fields.number(1, "x"), fields.number(2, "y"),
               arc_tangent2(2.0 * (qw * qz + qx * qy), norm - 2.0 * (qy * qy + qz * qz))};
  return pose;
}

}  // namespace

TumFile read_tum(LineReader& reader, Diagnostics& diagnostics) {
  TumFile file;
  file.name = reader.name();
  std::string_view line;
  while (reader.next(line)) {
    const Fields fields{line.substr(0, line.find('#'))};
    if (fields.size() == 0) { continue; }
    try {
      file.poses.push_back(parse_tum(fields));
    } catch (const BadLine& bad) {
      diagnostics.skipped_line(file.name, reader.line_number(), bad.cause);
    }
  }
  diagnostics.end_of_file(file.name);
  file.damage = reader.damage();
  if (file.poses.empty()) {
    throw UserError{ExitCode::input, file.name, "holds no valid pose",
                    "a TUM trajectory has lines 'stamp x y z qx qy qz qw'"};
  }
  return file;
}

}  // namespace picolo::host
