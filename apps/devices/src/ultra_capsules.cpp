// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "ultra_capsules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "picolo/core/crc.hpp"

namespace picolo::inline v0::devices {
namespace {

constexpr std::size_t kNodes = 96;
constexpr double kStep_deg = 0.8;     // 450 points a turn
constexpr double kReserve_deg = 3.0;  // no beam beyond 0.3 m looks aside by less
constexpr unsigned kNothing = 0x200;

double aside_deg(unsigned mm) {
  if (mm < 50) { return 7.5; }
  const double nearness = 98361.0 / (4.0 * mm);
  const double aside = 9150.0 - 64.0 * nearness - nearness * nearness * nearness / 98304.0;
  return aside / 65536.0 * 180.0 / std::numbers::pi;
}

struct Major {
  unsigned coded = 0;
  int mm = 0;  ///< what the code says
  unsigned shift = 0;
};

Major major_of(unsigned mm) {
  struct Scale {
    unsigned value_from, coded_from, shift;
  };
  constexpr std::array<Scale, 5> kScales{
      {{16384, 3328, 4}, {4096, 1792, 3}, {2048, 1280, 2}, {512, 512, 1}, {0, 0, 0}}};
  const Scale& scale = *std::find_if(kScales.begin(), kScales.end(),
                                     [mm](const Scale& s) { return mm >= s.value_from; });
  const unsigned steps = (mm - scale.value_from) >> scale.shift;
  return {scale.coded_from + steps, static_cast<int>(scale.value_from + (steps << scale.shift)),
          scale.shift};
}

unsigned predicted(unsigned mm, const Major& base) {
  const int steps = (static_cast<int>(mm) - base.mm) / (1 << base.shift);
  if (mm == 0 || steps < -511 || steps > 510) { return kNothing; }
  return static_cast<unsigned>(steps) & 0x3FFU;
}

}  // namespace

void seal_capsule(std::vector<std::uint8_t>& capsule) {
  const unsigned sum = xor8(std::span<const std::uint8_t>{capsule}.subspan(2));
  capsule[0] = static_cast<std::uint8_t>(0xA0U | (sum & 0xFU));
  capsule[1] = static_cast<std::uint8_t>(0x50U | (sum >> 4U));
}

unsigned UltraCapsules::node_mm(std::size_t node) const {
  const double head_deg = start_deg_ + static_cast<double>(node) * kStep_deg;
  auto away = [head_deg](const Point& point) { return std::abs(point.head_deg - head_deg); };
  const auto nearest = std::min_element(points_.begin(), points_.end(),
                                        [&](auto& a, auto& b) { return away(a) < away(b); });
  return nearest != points_.end() && away(*nearest) < kStep_deg ? nearest->mm : 0;
}

std::vector<std::uint8_t> UltraCapsules::capsule() const {
  std::vector<std::uint8_t> bytes(2);
  auto add = [&bytes](std::uint32_t value, int size) {
    for (int i = 0; i < size; ++i) { bytes.push_back(static_cast<std::uint8_t>(value >> 8 * i)); }
  };
  add(static_cast<std::uint32_t>(std::lround(std::fmod(start_deg_, 360.0) * 64.0)), 2);
  for (std::size_t node = 0; node < kNodes; node += 3) {
    const Major major = major_of(std::min(node_mm(node), 28'000U));
    const Major next = major_of(std::min(node_mm(node + 3), 28'000U));
    const Major& base = major.mm == 0 ? next : major;
    add(major.coded | predicted(node_mm(node + 1), base) << 12U |
            predicted(node_mm(node + 2), next) << 22U,
        4);
  }
  seal_capsule(bytes);
  return bytes;
}

std::vector<std::uint8_t> UltraCapsules::push(std::uint32_t angle_q6, unsigned mm) {
  const double turned_deg = std::fmod(angle_q6 / 64.0 - angle_deg_, 360.0);
  angle_deg_ += turned_deg < 0.0 ? turned_deg + 360.0 : turned_deg;
  points_.push_back({angle_deg_ + aside_deg(mm), mm});
  if (!started_) { start_deg_ = angle_deg_ + 8.0; }
  started_ = true;
  const double end_deg = start_deg_ + static_cast<double>(kNodes + 3) * kStep_deg;
  if (angle_deg_ + kReserve_deg < end_deg) { return {}; }
  const std::vector<std::uint8_t> full = capsule();
  start_deg_ += static_cast<double>(kNodes) * kStep_deg;
  std::erase_if(points_, [this](auto& point) { return point.head_deg < start_deg_ - kStep_deg; });
  return full;
}

}  // namespace picolo::inline v0::devices
