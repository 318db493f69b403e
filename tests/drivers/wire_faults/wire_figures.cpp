// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "wire_figures.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

#include "picolo/devices/wrong_rate.hpp"

namespace picolo::test {
namespace {

constexpr std::uint32_t kBefore = 8;   ///< good packets in front of the damage
constexpr std::uint32_t kDamaged = 3;  ///< packets that are damaged in turn
constexpr std::uint32_t kBehind = 8;

struct Stream {
  Bytes bytes;
  std::vector<std::size_t> ends;  ///< of every packet
  std::size_t first_damaged = 0;  ///< where packet kBefore begins
  /// What comes out undamaged (of capsules not the last, which waits for its successor).
  std::vector<Accepted> undamaged;
  [[nodiscard]] std::size_t end_damaged() const { return ends[kBefore + kDamaged - 1]; }
};

Stream make_stream(const Wire& wire) {
  Stream stream;
  for (std::uint32_t i = 0; i < kBefore + kDamaged + kBehind; ++i) {
    if (i == kBefore) { stream.first_damaged = stream.bytes.size(); }
    const Bytes packet = wire.packet(i);
    stream.bytes.insert(stream.bytes.end(), packet.begin(), packet.end());
    stream.ends.push_back(stream.bytes.size());
  }
  stream.undamaged = wire.read(stream.bytes);
  return stream;
}

/// `hit_first` to `hit_last`: the packets whose bytes were touched. `shift`: bytes that were
/// added (or, negative, taken away).
void judge(const Wire& wire, const Stream& stream, const Bytes& damaged, std::size_t hit_first,
           std::size_t hit_last, std::ptrdiff_t shift, Figures& figures) {
  ++figures.cases;
  const std::vector<Accepted> found = wire.read(damaged);
  const auto last_sent = static_cast<std::uint32_t>(stream.ends.size());
  std::set<std::uint32_t> seen;
  for (const Accepted& packet : found) {
    if (!packet.intact || packet.number >= last_sent || !seen.insert(packet.number).second) {
      ++figures.false_accepts;
    }
  }
  std::size_t lost_elsewhere = 0;
  bool following = false;
  for (const Accepted& packet : stream.undamaged) {
    if (packet.number >= hit_first && packet.number <= hit_last) { continue; }
    if (seen.count(packet.number) != 0) { continue; }
    ++lost_elsewhere;
    following = following || packet.number > hit_last;
  }
  figures.worst_lost = std::max(figures.worst_lost, lost_elsewhere);
  figures.following_lost += following ? 1U : 0U;
  const auto end_of_hit =
      static_cast<std::ptrdiff_t>(stream.ends[hit_last]) + std::max<std::ptrdiff_t>(shift, 0);
  for (const Accepted& packet : found) {
    if (packet.number <= hit_last || !packet.intact) { continue; }
    const std::ptrdiff_t wait = static_cast<std::ptrdiff_t>(packet.at) - end_of_hit;
    figures.worst_resync =
        std::max(figures.worst_resync, static_cast<std::size_t>(std::max<std::ptrdiff_t>(wait, 0)));
    break;
  }
}

std::size_t packet_of(const Stream& stream, std::size_t byte) {
  return static_cast<std::size_t>(std::upper_bound(stream.ends.begin(), stream.ends.end(), byte) -
                                  stream.ends.begin());
}

Figures flip_bits(const Wire& wire) {
  const Stream stream = make_stream(wire);
  Figures figures;
  for (std::size_t bit = 8 * stream.first_damaged; bit < 8 * stream.end_damaged(); ++bit) {
    const std::size_t packet = packet_of(stream, bit / 8);
    judge(wire, stream, with_bit_flipped(stream.bytes, bit), packet, packet, 0, figures);
  }
  return figures;
}

/// `damage(stream, at)` gives the damaged stream, and how many bytes longer it is.
template <typename Damage>
void at_every_byte(const Wire& wire, Figures& figures, const Damage& damage) {
  const Stream stream = make_stream(wire);
  for (std::size_t at = stream.first_damaged; at < stream.end_damaged(); ++at) {
    const std::size_t packet = packet_of(stream, at);
    const Bytes damaged = damage(stream, at);
    const auto longer = static_cast<std::ptrdiff_t>(damaged.size()) -
                        static_cast<std::ptrdiff_t>(stream.bytes.size());
    judge(wire, stream, damaged, packet, packet, longer, figures);
  }
}

Figures lose_bytes(const Wire& wire) {
  Figures figures;
  at_every_byte(wire, figures,
                [](const Stream& s, std::size_t at) { return without_byte(s.bytes, at); });
  return figures;
}

/// A byte added in front of the first one stands between two packets and hits neither; it may still
/// look like the header of the one behind it.
Figures add_bytes(const Wire& wire) {
  Figures figures;
  for (const std::uint8_t byte : Bytes{0x00, 0xFF, 0xAA, 0x55, 0x54, 0x0A}) {
    at_every_byte(wire, figures,
                  [byte](const Stream& s, std::size_t at) { return with_byte(s.bytes, at, byte); });
  }
  return figures;
}

Figures double_bytes(const Wire& wire) {
  Figures figures;
  at_every_byte(wire, figures, [](const Stream& s, std::size_t at) {
    return with_byte(s.bytes, at, s.bytes[at]);
  });
  return figures;
}

/// Pulled out within a packet and in again before the next.
Figures tear_off(const Wire& wire) {
  Figures figures;
  at_every_byte(wire, figures, [](const Stream& s, std::size_t at) {
    Bytes torn = s.bytes;
    const std::size_t end = s.ends[packet_of(s, at)];
    torn.erase(torn.begin() + static_cast<std::ptrdiff_t>(at),
               torn.begin() + static_cast<std::ptrdiff_t>(end));
    return torn;
  });
  return figures;
}

Figures burst(const Wire& wire) {
  const Stream stream = make_stream(wire);
  Random random{7};
  Figures figures;
  const std::size_t room = stream.end_damaged() - stream.first_damaged;
  for (int i = 0; i < 400; ++i) {
    const std::size_t begin =
        stream.first_damaged + random.below(static_cast<std::uint32_t>(room - 2));
    const std::size_t longest = std::min<std::size_t>(40, stream.end_damaged() - begin);
    const std::size_t length = 1 + random.below(static_cast<std::uint32_t>(longest));
    Bytes damaged = stream.bytes;
    for (std::size_t k = begin; k < begin + length; ++k) {
      damaged[k] = static_cast<std::uint8_t>(random.below(256));
    }
    judge(wire, stream, damaged, packet_of(stream, begin), packet_of(stream, begin + length - 1), 0,
          figures);
  }
  return figures;
}

Bytes packets(const Wire& wire, std::uint32_t count) {
  Bytes stream;
  for (std::uint32_t i = 0; i < count && i < wire.numbers; ++i) {
    const Bytes packet = wire.packet(i);
    stream.insert(stream.end(), packet.begin(), packet.end());
  }
  return stream;
}

NoiseFigures measure_noise(const Wire& wire) {
  const Bytes megabyte = noise(1'000'000, 3);
  NoiseFigures figures;
  figures.believed = wire.read(megabyte).size();
  // rplidar nodes: five in a row, ten check bits and four angles within 24 of 360 (and of 512)
  // degrees; the others: header and checksum.
  const double odds =
      undetectable(wire) ? std::exp2(-10.0) * 0.1 * 0.2 : std::exp2(-wire.checksum_bits);
  figures.expected = wire.name == "scip" ? 0.0 : 1e6 * odds;
  Bytes stream{megabyte.begin(), megabyte.begin() + 5000};
  const Bytes good = packets(wire, 20);
  stream.insert(stream.end(), good.begin(), good.end());
  std::set<std::uint32_t> found;
  for (const Accepted& packet : wire.read(stream)) {
    if (packet.intact && packet.at > 5000) { found.insert(packet.number); }
  }
  figures.found_behind = found.size();
  return figures;
}

std::size_t believed_at(const Wire& wire, double receiver_over_sender) {
  constexpr double kSender = 100'000.0;
  return wire
      .read(devices::received_at(packets(wire, 190), static_cast<std::uint32_t>(kSender),
                                 static_cast<std::uint32_t>(kSender * receiver_over_sender)))
      .size();
}

CanonicalFigures measure_canonical(const Wire& wire) {
  CanonicalFigures figures;
  Bytes stream;
  bool hit_before = true;
  for (std::uint32_t i = 0; i < 60 && i < wire.numbers; ++i) {
    bool hit = false;
    for (const std::uint8_t byte : wire.packet(i)) {
      const bool swallowed = byte == 0x03 || byte == 0x04 || byte == 0x11 || byte == 0x13 ||
                             byte == 0x16 || byte == 0x1A || byte == 0x1C;
      const bool changed = byte == 0x0D;
      hit = hit || swallowed || changed;
      if (!swallowed) { stream.push_back(changed ? std::uint8_t{0x0A} : byte); }
    }
    // A capsule is laid out by its successor: both have to be whole.
    const bool is_capsule = wire.lag >= 84;
    figures.untouched += !hit && !(is_capsule && hit_before) ? 1U : 0U;
    hit_before = hit;
  }
  std::set<std::uint32_t> good;
  for (const Accepted& packet : wire.read(stream)) {
    if (packet.intact) { good.insert(packet.number); }
    figures.wrong += packet.intact ? 0U : 1U;
  }
  figures.found = good.size();
  return figures;
}

}  // namespace

const std::vector<Fault>& all_faults() {
  static const std::vector<Fault> kFaults{{"bit flip", flip_bits},   {"byte lost", lose_bytes},
                                          {"byte added", add_bytes}, {"byte doubled", double_bytes},
                                          {"burst", burst},          {"torn off", tear_off}};
  return kFaults;
}

bool undetectable(const Wire& wire) {
  return wire.name == "rplidar 0x81";
}

WireFigures measure(const Wire& wire) {
  WireFigures figures{.wire = wire};
  for (const Fault& fault : all_faults()) { figures.faults.push_back(fault.measure(wire)); }
  figures.noise = measure_noise(wire);
  figures.believed_at_half = believed_at(wire, 0.5);
  figures.believed_at_double = believed_at(wire, 2.0);
  figures.canonical = measure_canonical(wire);
  return figures;
}

std::string to_table(const std::vector<WireFigures>& all) {
  char cell[160];
  std::string text = "| protocol | bytes |";
  std::string rule = "|---|---|";
  for (const Fault& fault : all_faults()) {
    text += std::string{" "} + fault.name + " |";
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const WireFigures& row : all) {
    text += "| " + row.wire.name + " | " + std::to_string(row.wire.packet(0).size()) + " |";
    for (const Figures& f : row.faults) {
      std::snprintf(cell, sizeof cell, " %zu: %zu, %zu, %zu, %zu |", f.cases, f.worst_lost,
                    f.following_lost, f.false_accepts, f.worst_resync);
      text += cell;
    }
    text += "\n";
  }
  text +=
      "\n| protocol | believed in 1 MB of noise (odds) | found behind it, of 20 | believed at half "
      "the rate | at double | untouched by a canonical terminal | found | wrong |\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (const WireFigures& row : all) {
    std::snprintf(cell, sizeof cell, "| %s | %zu (%.1f) | %zu | %zu | %zu | %zu | %zu | %zu |\n",
                  row.wire.name.c_str(), row.noise.believed, row.noise.expected,
                  row.noise.found_behind, row.believed_at_half, row.believed_at_double,
                  row.canonical.untouched, row.canonical.found, row.canonical.wrong);
    text += cell;
  }
  return text;
}

}  // namespace picolo::test
