// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/drivers/rplidar/rplidar_capsule.hpp"

#include <algorithm>

#include "picolo/core/bytes.hpp"

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kHeader = 4;
constexpr std::size_t kExpressCabins = 16;
constexpr std::size_t kUltraCabins = 32;
constexpr std::size_t kDenseCabins = 40;
constexpr std::int32_t kFullTurnQ8 = 360 << 8;
constexpr std::int32_t kFullTurnQ16 = 360 << 16;
constexpr std::int32_t kFullTurnQ6 = 360 << 6;
constexpr std::int32_t kMaxSpanQ8 = 120 << 8;

/// Distances of ultra capsules are coarser the longer they are.
struct Scale {
  std::uint32_t coded_from;
  std::uint32_t value_from;
  std::uint32_t shift;
};
constexpr std::array<Scale, 5> kScales{{{3328, 1U << 14U, 4},
                                        {1792, 1U << 12U, 3},
                                        {1280, 1U << 11U, 2},
                                        {512, 1U << 9U, 1},
                                        {0, 0, 0}}};

struct Major {
  std::int32_t distance = 0;
  std::uint32_t shift = 0;
};

Major expand(std::uint32_t coded) {
  for (const Scale& scale : kScales) {
    if (coded < scale.coded_from) { continue; }
    return {
        static_cast<std::int32_t>(scale.value_from + ((coded - scale.coded_from) << scale.shift)),
        scale.shift};
  }
  return {};
}

/// Ten bits, signed; the two ends of the range say "nothing measured".
std::uint32_t predicted_q2(std::uint32_t bits, const Major& base) {
  if (bits == 0x200U || bits == 0x1FFU) { return 0; }
  const std::int32_t offset =
      bits < 0x200U ? static_cast<std::int32_t>(bits) : static_cast<std::int32_t>(bits) - 0x400;
  const std::int32_t distance = base.distance + offset * (1 << base.shift);
  return distance > 0 ? static_cast<std::uint32_t>(distance) << 2U : 0U;
}

/// How far the beam looks beside its nominal angle, by the optics: 7.5 degrees when nothing was
/// measured, else 8 degrees minus what grows with nearness. In radians / 2^16, then in degrees.
std::int32_t optical_offset_q16(std::uint32_t dist_mm_q2) {
  constexpr std::int64_t kUnmeasured = 8578;
  constexpr std::int64_t kFar = 9150;
  constexpr std::uint32_t kNearest = 50 * 4;
  std::int64_t offset = kUnmeasured;
  if (dist_mm_q2 >= kNearest) {
    const std::int64_t nearness = 98361 / static_cast<std::int64_t>(dist_mm_q2);
    offset = kFar - nearness * 64 - nearness * nearness * nearness / 98304;
  }
  return static_cast<std::int32_t>(offset * 180 * 100'000'000 / 314'159'265);
}

std::size_t size_of(RplidarMode mode) {
  return mode == RplidarMode::ultra ? 132 : 84;
}

}  // namespace

RplidarCapsules::RplidarCapsules(RplidarMode mode) : mode_(mode), finder_(size_of(mode)) {}

void RplidarCapsules::reset(RplidarMode mode) {
  mode_ = mode;
  finder_.reset(size_of(mode));
  has_previous_ = false;
  last_span_q8_ = 0;
}

std::int32_t RplidarCapsules::start_q8(const Bytes& capsule) {
  return (load_u16_le(capsule, 2) & 0x7FFF) << 2;
}

std::size_t RplidarCapsules::push(std::uint8_t byte,
                                  std::span<RplidarNode, kRplidarMaxNodes> nodes) {
  if (!finder_.push(byte)) { return 0; }
  Bytes current{};
  std::copy(finder_.capsule().begin(), finder_.capsule().end(), current.begin());
  const std::uint32_t apart = finder_.position() - previous_position_;
  const bool adjacent = apart == capsule_size();
  previous_position_ = finder_.position();
  // Nearer than a capsule: the previous one swallowed a byte of this one. A few bytes farther, and
  // no capsule missing: it gained a byte that its sum, an exclusive-or, did not see.
  if (!adjacent && apart < capsule_size() + capsule_size() / 2 && has_previous_) {
    has_previous_ = false;
    ++implausible_;
  }
  // The device marks the first capsule after it was started: what came before is another scan.
  if ((current[3] & 0x80U) != 0) { has_previous_ = false; }

  std::size_t count = 0;
  if (has_previous_) {
    std::int32_t span_q8 = start_q8(current) - start_q8(previous_);
    if (span_q8 < 0) { span_q8 += kFullTurnQ8; }
    if (!adjacent) { span_q8 = last_span_q8_; }
    const bool possible = span_q8 <= kMaxSpanQ8 && (adjacent || span_q8 > 0);
    if (!possible) {
      ++implausible_;
    } else if (mode_ == RplidarMode::ultra) {
      count = decode_ultra(span_q8, adjacent ? &current : nullptr, nodes);
    } else if (mode_ == RplidarMode::dense) {
      count = decode_dense(span_q8, nodes);
    } else {
      count = decode_express(span_q8, nodes);
    }
    last_span_q8_ = possible ? span_q8 : 0;
  }
  previous_ = current;
  has_previous_ = true;
  return count;
}

RplidarNode RplidarCapsules::make_node(std::int32_t angle_q16, std::uint32_t dist_mm_q2,
                                       bool sync) {
  constexpr std::uint8_t kMeasured = 0x2F << 2;  // the wire carries no quality in these modes
  std::int32_t angle_q6 = (angle_q16 >> 10) % kFullTurnQ6;
  if (angle_q6 < 0) { angle_q6 += kFullTurnQ6; }
  return {.dist_mm_q2 = dist_mm_q2,
          .angle_z_q14 = static_cast<std::uint16_t>((angle_q6 << 8) / 90),
          .quality = dist_mm_q2 != 0 ? kMeasured : std::uint8_t{0},
          .flag = sync ? std::uint8_t{1} : std::uint8_t{2}};
}

/// True at the last node before the nominal angle passes 360 degrees, as in the vendor's library.
bool RplidarCapsules::starts_scan(std::int32_t angle_q16, std::int32_t step_q16) {
  // In dense mode also at the node behind, where that one is missing.
  const std::int32_t reach_q16 = mode_ == RplidarMode::dense ? 2 * step_q16 : step_q16;
  const bool inside = (angle_q16 + step_q16) % kFullTurnQ16 < reach_q16;
  const bool first = inside && !last_sync_;
  last_sync_ = inside;
  return first;
}

std::size_t RplidarCapsules::decode_express(std::int32_t span_q8, std::span<RplidarNode> nodes) {
  const std::int32_t step_q16 = span_q8 << 3;
  std::int32_t angle_q16 = start_q8(previous_) << 8;
  std::size_t count = 0;
  for (std::size_t cabin = 0; cabin < kExpressCabins; ++cabin) {
    const std::size_t at = kHeader + 5 * cabin;
    // Never negative, like the optical offset of ultra capsules: 7.5 degrees and up to half of one
    // more, minus what grows with nearness. Some public decoders read bit 5 as a sign.
    const unsigned offsets = previous_[at + 4];
    for (std::size_t half = 0; half < 2; ++half) {
      const unsigned word = load_u16_le(previous_, at + 2 * half);
      const unsigned low = half == 0 ? offsets & 0xFU : offsets >> 4U;
      const auto offset_q3 = static_cast<std::int32_t>(low | ((word & 3U) << 4U));
      const bool sync = starts_scan(angle_q16, step_q16);
      nodes[count] = make_node(angle_q16 - (offset_q3 << 13), word & 0xFFFCU, sync);
      angle_q16 += step_q16;
      ++count;
    }
  }
  return count;
}

std::size_t RplidarCapsules::decode_ultra(std::int32_t span_q8, const Bytes* next,
                                          std::span<RplidarNode> nodes) {
  const std::int32_t step_q16 = (span_q8 << 3) / 3;
  std::int32_t angle_q16 = start_q8(previous_) << 8;
  std::size_t count = 0;
  for (std::size_t cabin = 0; cabin < kUltraCabins; ++cabin) {
    const std::uint32_t word = load_u32_le(previous_, kHeader + 4 * cabin);
    std::uint32_t following = 0;  // unknown where the next capsule was lost
    if (cabin + 1 < kUltraCabins) {
      following = load_u32_le(previous_, kHeader + 4 * (cabin + 1));
    } else if (next != nullptr) {
      following = load_u32_le(*next, kHeader);
    }
    const bool following_known = cabin + 1 < kUltraCabins || next != nullptr;
    const Major major = expand(word & 0xFFFU);
    const Major major_next = expand(following & 0xFFFU);
    const Major base = major.distance == 0 && major_next.distance != 0 ? major_next : major;
    const std::array<std::uint32_t, 3> dist_q2{
        static_cast<std::uint32_t>(major.distance) << 2U,
        predicted_q2((word >> 12U) & 0x3FFU, base),
        following_known ? predicted_q2(word >> 22U, major_next) : 0U};
    for (const std::uint32_t dist : dist_q2) {
      const bool sync = starts_scan(angle_q16, step_q16);
      nodes[count] = make_node(angle_q16 - optical_offset_q16(dist), dist, sync);
      angle_q16 += step_q16;
      ++count;
    }
  }
  return count;
}

std::size_t RplidarCapsules::decode_dense(std::int32_t span_q8, std::span<RplidarNode> nodes) {
  const std::int32_t step_q16 = (span_q8 << 8) / static_cast<std::int32_t>(kDenseCabins);
  std::int32_t angle_q16 = start_q8(previous_) << 8;
  for (std::size_t cabin = 0; cabin < kDenseCabins; ++cabin) {
    const std::uint32_t dist_mm = load_u16_le(previous_, kHeader + 2 * cabin);
    const bool sync = starts_scan(angle_q16, step_q16);
    nodes[cabin] = make_node(angle_q16, dist_mm << 2U, sync);
    angle_q16 += step_q16;
  }
  return kDenseCabins;
}

}  // namespace picolo::inline v0
