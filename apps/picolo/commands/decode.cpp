// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <vector>

#include "commands.hpp"
#include "decode/imus.hpp"
#include "decode/lidars.hpp"
#include "decode/protocols.hpp"
#include "picolo/host/error.hpp"

namespace picolo::tool {

const std::vector<SerialDecoder>& serial_decoders() {
  static const std::vector<SerialDecoder> kDecoders{
      {"ld06", decode_ld06},       {"rplidar", decode_rplidar},     {"scip", decode_scip},
      {"ydlidar", decode_ydlidar}, {"witmotion", decode_witmotion}, {"bno08x-rvc", decode_bno08x},
      {"xsens", decode_xsens},     {"vectornav", decode_vectornav}};
  return kDecoders;
}

namespace {

constexpr const char* kDbc = "dbc:";

struct Options {
  std::string protocol;
  std::string file;
  DecodeOptions decode;
};

std::string protocol_names() {
  std::string names;
  for (const SerialDecoder& decoder : serial_decoders()) { names += decoder.name + ", "; }
  for (const CanDecoder& decoder : can_decoders()) { names += decoder.name + ", "; }
  return names + "dbc:FILE";
}

DecodeResult decode_stream(const Options& options, std::istream& input) {
  for (const CanDecoder& decoder : can_decoders()) {
    if (decoder.name == options.protocol) { return decoder.decode(input, options.decode); }
  }
  if (options.protocol.rfind(kDbc, 0) == 0) {
    return decode_dbc(options.protocol.substr(4), input, options.decode);
  }
  for (const SerialDecoder& decoder : serial_decoders()) {
    if (decoder.name != options.protocol) { continue; }
    const std::vector<char> text{std::istreambuf_iterator<char>{input}, {}};
    const std::vector<std::uint8_t> bytes(text.begin(), text.end());
    return decoder.decode(bytes, options.decode);
  }
  throw host::UserError{ExitCode::usage, options.protocol, "no such protocol",
                        "use one of " + protocol_names()};
}

ExitCode decode(const Options& options) {
  DecodeResult result;
  if (options.file == "-") {
    result = decode_stream(options, std::cin);
  } else {
    std::ifstream file{options.file, std::ios::binary};
    if (!file) {
      throw host::UserError{ExitCode::input, options.file, "cannot be opened",
                            "check name and permissions, or give - for standard input"};
    }
    result = decode_stream(options, file);
  }
  const SerialCounters& c = result.counters;
  if (result.bad_lines > 0) {
    fmt::print(stderr, "picolo: {}: {} lines are no classic CAN frame\n", options.file,
               result.bad_lines);
  }
  if (c.bad_checksums + c.implausible + c.skipped_bytes > 0) {
    fmt::print(stderr,
               "picolo: {}: {} good frames, {} with a wrong checksum, {} impossible ones, {} bytes "
               "in no frame\n",
               options.file, c.frames, c.bad_checksums, c.implausible, c.skipped_bytes);
  }
  if (result.samples > 0) { return ExitCode::done; }
  throw host::UserError{ExitCode::input, options.file,
                        fmt::format("holds nothing that {} would say", options.protocol),
                        "serial devices: raw bytes as they came; CAN: a log of candump -L or "
                        "candump; rplidar without descriptors: name the --mode"};
}

}  // namespace

void add_decode(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("decode", "Shows what a device said, sample by sample");
  command->add_option("protocol", options->protocol, "One of " + protocol_names())
      ->required()
      ->type_name("PROTOCOL");
  command->add_option("file", options->file, "Raw bytes, or a candump log; - is standard input")
      ->required()
      ->type_name("FILE");
  command->add_flag("--json", options->decode.json, "Print one JSON object a line");
  command
      ->add_option("--mode", options->decode.mode,
                   "rplidar: what the stream is where it shows no descriptor [what fits best]")
      ->check(CLI::IsMember({"standard", "express", "ultra", "dense"}));
  command->footer(
      "Prints CSV: one header line, then one line a sample; CAN logs one line a value. What was\n"
      "damaged is counted on standard error. The decoders are those of the drivers.\n"
      "\n"
      "Examples:\n"
      "  picolo decode ld06 /tmp/lidar.bin > points.csv\n"
      "  picolo decode rplidar --mode ultra stream.bin\n"
      "  candump -L can0 | picolo decode dbc:body.dbc -\n"
      "  picolo decode canopen start-up.candump --json");
  command->callback([&action, options] { action = [options] { return decode(*options); }; });
}

}  // namespace picolo::tool
