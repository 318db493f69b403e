// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/sim/beam_packets.hpp"

#include <algorithm>
#include <numbers>

#include "picolo/core/convert.hpp"
#include "picolo/core/math.hpp"
#include "picolo/core/number_model.hpp"

namespace picolo::inline v0::sim {
namespace {

constexpr std::int32_t kTurn = 36'000;
constexpr std::int32_t kWidest = 1200;  ///< of a packet, centidegrees: 1 deg a point
constexpr std::int32_t kWorthFilling = 200;
constexpr double kPointSpacing = 100.0;
constexpr double kTolerance = 2.0;
constexpr double kLastPoint = 11.0;
constexpr std::uint8_t kHitIntensity = 200;

std::int32_t rounded(double value_cdeg) {
  return static_cast<std::int32_t>(round_to_i64(value_cdeg, 0, 2 * kTurn));
}

void set_angles(Ld06Packet& packet, std::int32_t start, std::int32_t end) {
  packet.start_cdeg = static_cast<std::uint16_t>(start % kTurn);
  packet.end_cdeg = static_cast<std::uint16_t>(end % kTurn);
}

void set_point(Ld06Packet& packet, std::size_t point, std::uint16_t range_mm) {
  packet.range_mm[point] = range_mm;
  packet.intensity[point] = range_mm > 0 ? kHitIntensity : 0;
}

}  // namespace

BeamPackets::Beam BeamPackets::to_beam(const RecordedBeam& beam) {
  double angle = static_cast<double>(beam.bearing_rad) * (-18'000.0 / std::numbers::pi);
  while (angle < 0.0) { angle += kTurn; }
  while (angle >= kTurn - 0.5) { angle -= kTurn; }  // what would round to a full turn is 0
  const double range_mm = static_cast<double>(beam.range_m) * 1000.0;
  const bool expressible = range_mm > 0.0 && range_mm < 65'535.5;
  return {.clockwise_cdeg = std::max(angle, 0.0),
          .range_mm = static_cast<std::uint16_t>(expressible ? round_to_i64(range_mm, 0, 65'535)
                                                             : std::int64_t{0})};
}

std::size_t BeamPackets::load(std::span<const RecordedBeam> beams) {
  size_ = 0;
  next_ = 0;
  at_cdeg_ = 0;
  std::size_t left_out = 0;
  for (const RecordedBeam& beam : beams) {
    const bool has_direction = beam.bearing_rad >= -100.0F && beam.bearing_rad <= 100.0F;
    if (size_ == kMaxBeams || !has_direction) {
      ++left_out;
      continue;
    }
    beams_[size_] = to_beam(beam);
    ++size_;
  }
  // Equal angles are ordered by range, so that the result does not depend on the sort.
  std::sort(beams_.begin(), beams_.begin() + static_cast<std::ptrdiff_t>(size_),
            [](const Beam& a, const Beam& b) {
              if (a.clockwise_cdeg != b.clockwise_cdeg) {
                return a.clockwise_cdeg < b.clockwise_cdeg;
              }
              return a.range_mm < b.range_mm;
            });
  return left_out;
}

bool BeamPackets::next(Ld06Packet& packet) {
  packet.range_mm.fill(0);
  packet.intensity.fill(0);
  const std::int32_t goal = next_ < size_ ? rounded_angle(next_) : kTurn;
  if (next_ == size_ && at_cdeg_ >= kTurn) { return false; }
  if (next_ == size_ || goal - at_cdeg_ >= kWorthFilling) {
    lay_empty(goal, packet);
    return true;
  }
  if (!lay_evenly(packet)) { lay_single(packet); }
  return true;
}

/// Splits what lies before `end_cdeg` into equal packets and lays the first of them.
void BeamPackets::lay_empty(std::int32_t end_cdeg, Ld06Packet& packet) {
  const std::int32_t gap = end_cdeg - at_cdeg_;
  const std::int32_t width = gap / ((gap + kWidest - 1) / kWidest);
  set_angles(packet, at_cdeg_, at_cdeg_ + width * 11 / 12);
  at_cdeg_ += width;
}

/// Twelve points at the spacing of the next two beams, or at a whole fraction of it; false when the
/// beams are not even enough.
bool BeamPackets::lay_evenly(Ld06Packet& packet) {
  const bool alone = next_ + 1 == size_;
  const double first = beams_[next_].clockwise_cdeg;
  const double spacing = alone ? kPointSpacing : beams_[next_ + 1].clockwise_cdeg - first;
  const std::int32_t spacings = -floor_to_i32(-spacing / kPointSpacing, -kTurn, 0);  // rounded up
  const std::int32_t points_per_beam = std::max<std::int32_t>(spacings, 1);
  const double step = spacing / static_cast<double>(points_per_beam);
  const std::int32_t start = rounded_angle(next_);
  const std::int32_t end = rounded(first + kLastPoint * step);
  const double wire_step = static_cast<double>(end - start) / kLastPoint;

  std::size_t beam = next_;
  for (std::int32_t point = 0; point <= 11 && beam < size_; point += points_per_beam) {
    const double error =
        beams_[beam].clockwise_cdeg - (static_cast<double>(start) + wire_step * point);
    if (error > kTolerance || error < -kTolerance) { break; }
    set_point(packet, static_cast<std::size_t>(point), beams_[beam].range_mm);
    ++beam;
  }
  if (beam < size_ && beams_[beam].clockwise_cdeg <= static_cast<double>(end)) { return false; }
  set_angles(packet, start, end);
  next_ = beam;
  at_cdeg_ = end + 1;
  return true;
}

/// One beam on the first point, the others squeezed in before the beam that follows.
void BeamPackets::lay_single(Ld06Packet& packet) {
  const std::int32_t start = rounded_angle(next_);
  const std::int32_t room = std::clamp<std::int32_t>(rounded_angle(next_ + 1) - start, 0, kWidest);
  const std::int32_t end = start + room * 11 / 12;
  packet.range_mm.fill(0);
  packet.intensity.fill(0);
  set_point(packet, 0, beams_[next_].range_mm);
  set_angles(packet, start, end);
  ++next_;
  at_cdeg_ = end + 1;
}

/// Precondition: index < size_.
std::int32_t BeamPackets::rounded_angle(std::size_t index) const {
  return rounded(beams_[index].clockwise_cdeg);
}

}  // namespace picolo::inline v0::sim
