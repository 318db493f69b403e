// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Any image of a store into what reads it at start-up.
#include <algorithm>
#include <array>
#include <memory>

#include "picolo/map/map_codec.hpp"
#include "targets.hpp"

namespace picolo::fuzz {
namespace {

RollingMap<64, 64>& target_map() {
  static const auto map = std::make_unique<RollingMap<64, 64>>();
  return *map;
}

void map_header(Input input) {
  MapHeader header;
  if (!is_ok(decode_map_header(input, header))) { return; }
  std::array<std::uint8_t, kMapHeaderSize> again{};
  encode_map_header(header, again);
  MapHeader twice;
  require(is_ok(decode_map_header(again, twice)), "an accepted header does not come back");
}

/// The header is ours, so that the checksum does not stop every input; the payload is anybody's.
void map_payload(Input input) {
  Reader reader{input};
  RollingMapCore& map = target_map().core();
  MapHeader header;
  header.window = map.window();
  header.window.width = 8 * (1 + reader.byte() % 12);
  header.window.height = 8 * (1 + reader.byte() % 12);
  MapDecoder decoder;
  if (!is_ok(decoder.begin(header, map))) { return; }
  while (!reader.empty()) {
    const Input rest = reader.rest();
    const std::size_t piece = std::min<std::size_t>(1 + reader.byte() % 64U, rest.size());
    if (!is_ok(decoder.decode(rest.first(piece)))) { return; }
    for (std::size_t i = 1; i < piece; ++i) { (void)reader.byte(); }
  }
}

}  // namespace

std::vector<Target> store_targets() {
  // The map is allocated once, by the first run.
  return {{"store-header", map_header, true}, {"store-map", map_payload, false}};
}

}  // namespace picolo::fuzz
