// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/lidar_scans3.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "byte_source.hpp"
#include "picolo/host/error.hpp"

namespace picolo::host {
namespace {

constexpr std::size_t kScanHeader = 16;
constexpr std::size_t kPointBytes = 8;

template <typename T>
T value_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// Rings by elevation, returns of each by azimuth.
RingScan sorted_into_rings(const std::vector<Vector3f>& points, const RingModel& model) {
  RingScan scan;
  scan.rings.resize(model.rings);
  for (const Vector3f& p : points) {
    const double elevation_deg =
        std::atan2(static_cast<double>(p.z),
                   std::hypot(static_cast<double>(p.x), static_cast<double>(p.y))) *
        180.0 / std::numbers::pi;
    const double share =
        (model.highest_deg - elevation_deg) / (model.highest_deg - model.lowest_deg);
    if (!(share >= 0.0 && share <= 1.0)) { continue; }
    const auto ring =
        static_cast<std::size_t>(std::lround(share * static_cast<double>(model.rings - 1)));
    scan.rings[ring].push_back({p, 0.0F});
  }
  for (auto& ring : scan.rings) {
    std::stable_sort(ring.begin(), ring.end(), [](const RingPoint& a, const RingPoint& b) {
      return std::atan2(a.point_m.y, a.point_m.x) < std::atan2(b.point_m.y, b.point_m.x);
    });
  }
  return scan;
}

}  // namespace

std::size_t RingScan::size() const {
  std::size_t total = 0;
  for (const auto& ring : rings) { total += ring.size(); }
  return total;
}

ScanReader::ScanReader(const std::string& path, const RingModel& model)
    : name_(path), model_(model), rings_(model.rings) {
  if (!std::filesystem::is_directory(path)) {
    open_l3d(path);
    return;
  }
  for (const auto& entry : std::filesystem::directory_iterator{path}) {
    const auto extension = entry.path().extension();
    if (extension == ".bin" || extension == ".ply") { files_.push_back(entry.path()); }
  }
  if (files_.empty()) {
    throw UserError{ExitCode::input, path, "holds no .bin and no .ply file",
                    "give a folder of KITTI or PLY scans, or a .l3d file"};
  }
  std::sort(files_.begin(), files_.end());
  scans_ = files_.size();
  kitti_ = files_.front().extension() == ".bin";
}

void ScanReader::open_l3d(const std::string& path) {
  ByteSource source{path};
  while (source.append_to(bytes_)) {}
  damage_ = source.damage();
  if (bytes_.size() < 20 || !bytes_.starts_with("L3D1")) {
    throw UserError{ExitCode::input, path, "does not begin with L3D1",
                    "give a .l3d log, plain or .gz, or a folder of .bin or .ply scans"};
  }
  scans_ = value_at<std::uint32_t>(bytes_, 4);
  rings_ = value_at<std::uint32_t>(bytes_, 8);
  scale_m_ = value_at<float>(bytes_, 16);
  if (rings_ == 0 || rings_ > 256 || !(scale_m_ > 0.0F)) {
    throw UserError{ExitCode::input, path,
                    fmt::format("its header says {} rings and a scale of {:g} m", rings_,
                                static_cast<double>(scale_m_)),
                    "the file is damaged, get a whole copy"};
  }
  at_ = 20;
  kitti_ = true;
}

bool ScanReader::next_l3d(RingScan& scan) {
  if (index_ == scans_) { return false; }
  const std::size_t left = bytes_.size() - at_;
  const std::size_t count = left < kScanHeader ? 0 : value_at<std::uint32_t>(bytes_, at_ + 4);
  if (left < kScanHeader || (left - kScanHeader) / kPointBytes < count) {
    if (damage_.empty()) { damage_ = fmt::format("is cut in scan {} of {}", index_, scans_); }
    return false;
  }
  scan.stamp_s = value_at<double>(bytes_, at_ + 8);
  at_ += kScanHeader;
  for (std::size_t k = 0; k < count; ++k, at_ += kPointBytes) {
    const auto along = [&](std::size_t axis) {
      return scale_m_ * static_cast<float>(value_at<std::int16_t>(bytes_, at_ + 2 * axis));
    };
    const std::size_t ring = static_cast<unsigned char>(bytes_[at_ + 6]);
    if (ring < rings_) { scan.rings[ring].push_back({{along(0), along(1), along(2)}, 0.0F}); }
  }
  return true;
}

bool ScanReader::next(RingScan& scan) {
  scan.rings.assign(rings_, {});
  if (files_.empty()) {
    const bool more = next_l3d(scan);
    index_ += more ? 1 : 0;
    return more;
  }
  if (index_ == files_.size()) { return false; }
  const auto& file = files_[index_];
  scan = sorted_into_rings(file.extension() == ".bin" ? read_float_points(file, 4) : read_ply(file),
                           model_);
  scan.stamp_s = 0.1 * static_cast<double>(index_);
  ++index_;
  return true;
}

void correct_elevation(RingScan& scan, double angle_rad) {
  const double cosine = std::cos(angle_rad);
  const double sine = std::sin(angle_rad);
  for (auto& ring : scan.rings) {
    for (RingPoint& point : ring) {
      Vector3f& p = point.point_m;
      const double out_m = std::hypot(static_cast<double>(p.x), static_cast<double>(p.y));
      if (!(out_m > 0.0)) { continue; }
      const double z_m = static_cast<double>(p.z);
      const double share = (out_m * cosine - z_m * sine) / out_m;
      p = {static_cast<float>(static_cast<double>(p.x) * share),
           static_cast<float>(static_cast<double>(p.y) * share),
           static_cast<float>(out_m * sine + z_m * cosine)};
    }
  }
}

}  // namespace picolo::host
