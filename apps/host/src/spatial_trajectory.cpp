// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/spatial_trajectory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <optional>

#include "fields.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"

namespace picolo::host {
namespace {

constexpr double kNanosecond_s = 1e-9;

Matrix3d rotation_of(const Fields& fields, std::size_t w, std::size_t x) {
  const Quaterniond q{fields.number(w, "qw"), fields.number(x, "qx"), fields.number(x + 1, "qy"),
                      fields.number(x + 2, "qz")};
  const double norm2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  if (!(norm2 > 0.5 && norm2 < 2.0)) {
    throw BadLine{fmt::format("quaternion of squared length {:.6g}, expected 1", norm2)};
  }
  return to_matrix(q);
}

Vector3d position_of(const Fields& fields) {
  return {fields.number(1, "x"), fields.number(2, "y"), fields.number(3, "z")};
}

void parse(const Fields& fields, SpatialTrajectory& trajectory) {
  Transform3d pose;
  switch (trajectory.format) {
    case TrajectoryFormat::tum:
      fields.expect_size(8, "a TUM pose");
      pose = {rotation_of(fields, 7, 4), position_of(fields)};
      trajectory.stamps_s.push_back(fields.number(0, "stamp"));
      break;
    case TrajectoryFormat::kitti:
      fields.expect_size(12, "a KITTI pose");
      for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column) {
          pose.rotation(row, column) = fields.number(4 * row + column, "matrix element");
        }
      }
      pose.translation_m = {fields.number(3, "x"), fields.number(7, "y"), fields.number(11, "z")};
      break;
    case TrajectoryFormat::euroc:
      pose = {rotation_of(fields, 4, 5), position_of(fields)};
      trajectory.stamps_s.push_back(fields.number(0, "stamp") * kNanosecond_s);
      break;
  }
  trajectory.poses.push_back(pose);
}

std::optional<TrajectoryFormat> format_of(const Fields& fields, bool commas) {
  if (commas && fields.size() >= 8) { return TrajectoryFormat::euroc; }
  if (fields.size() == 8) { return TrajectoryFormat::tum; }
  if (fields.size() == 12) { return TrajectoryFormat::kitti; }
  return std::nullopt;
}

void sort_by_stamp(SpatialTrajectory& trajectory) {
  const auto& stamps = trajectory.stamps_s;
  if (std::is_sorted(stamps.begin(), stamps.end())) { return; }
  std::vector<std::size_t> order(stamps.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stamps[a] < stamps[b]; });
  SpatialTrajectory sorted = trajectory;
  for (std::size_t i = 0; i < order.size(); ++i) {
    sorted.stamps_s[i] = stamps[order[i]];
    sorted.poses[i] = trajectory.poses[order[i]];
  }
  trajectory = std::move(sorted);
}

}  // namespace

SpatialTrajectory read_spatial_trajectory(LineReader& reader, Diagnostics& diagnostics) {
  SpatialTrajectory trajectory;
  trajectory.name = reader.name();
  std::optional<TrajectoryFormat> format;
  std::string_view view;
  while (reader.next(view)) {
    std::string line{view.substr(0, view.find('#'))};
    const bool commas = line.find(',') != std::string::npos;
    std::replace(line.begin(), line.end(), ',', ' ');
    const Fields fields{line};
    if (fields.size() == 0) { continue; }
    if (!format) {
      format = format_of(fields, commas);
      if (!format) {
        throw UserError{
            ExitCode::input, trajectory.name,
            fmt::format("line {} has {} fields, which is no pose", reader.line_number(),
                        fields.size()),
            "give TUM (stamp x y z qx qy qz qw), KITTI (12 matrix elements) or EuRoC (comma "
            "separated) text"};
      }
      trajectory.format = *format;
    }
    try {
      parse(fields, trajectory);
    } catch (const BadLine& bad) {
      diagnostics.skipped_line(trajectory.name, reader.line_number(), bad.cause);
    }
  }
  diagnostics.end_of_file(trajectory.name);
  trajectory.damage = reader.damage();
  if (trajectory.poses.empty()) {
    throw UserError{ExitCode::input, trajectory.name, "holds no valid pose",
                    "give TUM, KITTI or EuRoC text, plain or .gz"};
  }
  sort_by_stamp(trajectory);
  return trajectory;
}

void write_spatial_trajectory(const std::filesystem::path& path,
                              const SpatialTrajectory& trajectory, TrajectoryFormat format) {
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  if (format == TrajectoryFormat::euroc) {
    fmt::format_to(out, "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w,q_x,q_y,q_z\n");
  }
  for (std::size_t i = 0; i < trajectory.poses.size(); ++i) {
    const Transform3d& pose = trajectory.poses[i];
    const Vector3d& t = pose.translation_m;
    const Matrix3d& r = pose.rotation;
    if (format == TrajectoryFormat::kitti) {
      fmt::format_to(out,
                     "{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} "
                     "{:.9f} {:.9f}\n",
                     r(0, 0), r(0, 1), r(0, 2), t.x, r(1, 0), r(1, 1), r(1, 2), t.y, r(2, 0),
                     r(2, 1), r(2, 2), t.z);
      continue;
    }
    const double stamp_s =
        trajectory.stamps_s.empty() ? static_cast<double>(i) : trajectory.stamps_s[i];
    const Quaterniond q = from_matrix(r);
    if (format == TrajectoryFormat::tum) {
      fmt::format_to(out, "{:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f} {:.9f}\n", stamp_s, t.x,
                     t.y, t.z, q.x, q.y, q.z, q.w);
    } else {
      fmt::format_to(out, "{:.0f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f},{:.9f}\n",
                     stamp_s / kNanosecond_s, t.x, t.y, t.z, q.w, q.x, q.y, q.z);
    }
  }
  write_file(path, {text.data(), text.size()});
}

}  // namespace picolo::host
