// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The decoders per byte (serial) and per frame (CAN), on well-formed traffic.

#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "picolo/drivers/canopen/canopen_wheels.hpp"
#include "picolo/drivers/ld06/ld06_decoder.hpp"
#include "picolo/drivers/witmotion/witmotion_frame.hpp"
#include "picolo/sim/ld06_wire.hpp"
#include "picolo/sim/witmotion_wire.hpp"

namespace picolo::bench {
namespace {

void per_byte(benchmark::State& state, std::size_t bytes) {
  state.counters["per_byte"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(bytes),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void ld06(benchmark::State& state) {
  std::vector<std::uint8_t> stream;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const auto packet = sim::encode(sim::Ld06Packet{});
    stream.insert(stream.end(), packet.begin(), packet.end());
  }
  Ld06Decoder decoder;
  int packets = 0;
  for (auto _ : state) {
    for (const std::uint8_t byte : stream) { packets += is_ok(decoder.push(byte)) ? 1 : 0; }
  }
  if (packets == 0) { state.SkipWithError("no packet was decoded"); }
  per_byte(state, stream.size());
}
BENCHMARK(ld06)->Name("decode/ld06");

void witmotion(benchmark::State& state) {
  std::vector<std::uint8_t> stream;
  for (int i = 0; i < 1000; ++i) {
    for (const std::uint8_t type : {sim::kWitMotionAcceleration, sim::kWitMotionRate}) {
      sim::WitMotionFrame frame{};
      frame.type = type;
      const auto bytes = sim::encode(frame);
      stream.insert(stream.end(), bytes.begin(), bytes.end());
    }
  }
  WitMotionDecoder decoder;
  int frames = 0;
  for (auto _ : state) {
    for (const std::uint8_t byte : stream) { frames += is_ok(decoder.push(byte)) ? 1 : 0; }
  }
  if (frames == 0) { state.SkipWithError("no frame was decoded"); }
  per_byte(state, stream.size());
}
BENCHMARK(witmotion)->Name("decode/witmotion");

}  // namespace
}  // namespace picolo::bench
