// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Scans of spinning 3D lidars: .l3d logs, and folders of KITTI .bin or of .ply files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "picolo/geometry/vector3.hpp"
#include "picolo/odometry/scan_features.hpp"

namespace picolo::host {

/// Returns by ring, in the order of azimuth; stamps of returns are 0 (compensated data).
struct RingScan {
  double stamp_s = 0.0;
  std::vector<std::vector<RingPoint>> rings;
  [[nodiscard]] std::size_t size() const;
};

/// How rings are told apart in files that do not say: even steps of elevation.
struct RingModel {
  std::size_t rings = 64;
  double lowest_deg = -25.0;
  double highest_deg = 3.0;
};

/// Scans one after the other. Throws UserError (input) with file, cause and cure.
class ScanReader {
 public:
  /// A .l3d file (plain or .gz), or a folder with .bin or .ply scans in the order of their names.
  explicit ScanReader(const std::string& path, const RingModel& model = {});

  [[nodiscard]] std::size_t scans() const { return scans_; }
  [[nodiscard]] std::size_t rings() const { return rings_; }
  [[nodiscard]] const std::string& name() const { return name_; }
  /// Recorded by KITTI's lidar: .l3d and .bin.
  [[nodiscard]] bool is_kitti() const { return kitti_; }
  /// False at the end, or where the file is cut (see damage).
  bool next(RingScan& scan);
  [[nodiscard]] const std::string& damage() const { return damage_; }

 private:
  bool next_l3d(RingScan& scan);
  void open_l3d(const std::string& path);

  std::string name_;
  RingModel model_;
  std::vector<std::filesystem::path> files_;  ///< of a folder
  std::string bytes_;                         ///< of a .l3d
  std::size_t at_ = 0;
  std::size_t index_ = 0;
  std::size_t scans_ = 0;
  std::size_t rings_ = 0;
  float scale_m_ = 0.0F;
  bool kitti_ = false;
  std::string damage_;
};

/// x y z of a PLY file: ascii or binary little-endian, float or double. Throws UserError (input).
[[nodiscard]] std::vector<Vector3f> read_ply(const std::filesystem::path& path);
/// The first three of every `fields` little-endian floats of a headerless file.
[[nodiscard]] std::vector<Vector3f> read_float_points(const std::filesystem::path& path,
                                                      std::size_t fields);

/// Turns every return up by the angle, about its own horizontal axis (p x z): what KITTI's vertical
/// angles lack.
void correct_elevation(RingScan& scan, double angle_rad);

}  // namespace picolo::host
