// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>
#include <vector>

#include "commands.hpp"
#include "decode/imus.hpp"
#include "decode/lidars.hpp"
#include "decode/protocols.hpp"
#include "picolo/devices/candump.hpp"
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

/// What the file may be instead, empty when nobody knows.
std::string looks_like(const std::vector<char>& text, bool is_can, const std::string& tried) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  for (const SerialDecoder& decoder : serial_decoders()) {
    if (decoder.name == tried) { continue; }
    const DecodeResult result = decoder.decode(bytes, {.format = TableFormat::nothing, .mode = {}});
    if (result.samples > 0 && 2 * std::size_t{result.counters.skipped_bytes} < bytes.size()) {
      return decoder.name;
    }
  }
  const std::string line{text.begin(), std::find(text.begin(), text.end(), '\n')};
  return !is_can && devices::parse_candump(line)
             ? "a candump log: canopen, odrive, vesc or dbc:FILE"
             : "";
}

[[noreturn]] void refuse(const Options& options, const std::vector<char>& text) {
  if (text.empty() && options.file != "-") {
    throw host::UserError{ExitCode::input, options.file, "is empty",
                          "record again: nothing has arrived ('picolo doctor' tells why)"};
  }
  const bool is_can = options.protocol.rfind(kDbc, 0) == 0 ||
                      std::any_of(can_decoders().begin(), can_decoders().end(),
                                  [&](auto& decoder) { return decoder.name == options.protocol; });
  const std::string other = looks_like(text, is_can, options.protocol);
  std::string cure = is_can ? "give a log of candump -L or candump from the bus that speaks it"
                            : "give the raw bytes as they came, at the device's baud rate";
  if (!other.empty()) { cure = "it looks like " + other; }
  throw host::UserError{ExitCode::input, options.file,
                        fmt::format("holds nothing that {} would say", options.protocol), cure};
}

DecodeResult decode_bytes(const SerialDecoder& decoder, std::istream& input,
                          const Options& options) {
  const std::vector<char> text{std::istreambuf_iterator<char>{input}, {}};
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  return decoder.decode(bytes, options.decode);
}

DecodeResult decode_stream(const Options& options, std::istream& input) {
  for (const CanDecoder& decoder : can_decoders()) {
    if (decoder.name == options.protocol) { return decoder.decode(input, options.decode); }
  }
  if (options.protocol.rfind(kDbc, 0) == 0) {
    return decode_dbc(options.protocol.substr(4), input, options.decode);
  }
  for (const SerialDecoder& decoder : serial_decoders()) {
    if (decoder.name == options.protocol) { return decode_bytes(decoder, input, options); }
  }
  throw host::UserError{ExitCode::usage, options.protocol, "no such protocol",
                        "use one of " + protocol_names()};
}

std::ifstream open_file(const std::string& path) {
  if (std::filesystem::is_directory(path)) {
    throw host::UserError{ExitCode::input, path, "is a folder", "name a file in it"};
  }
  std::ifstream file{path, std::ios::binary};
  if (!file) {
    throw host::UserError{ExitCode::input, path, "cannot be opened",
                          "check name and permissions, or give - for standard input"};
  }
  return file;
}

ExitCode decode(const Options& options) {
  DecodeResult result;
  if (options.file == "-") {
    result = decode_stream(options, std::cin);
  } else {
    std::ifstream file = open_file(options.file);
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
  std::ifstream again{options.file == "-" ? "/dev/null" : options.file, std::ios::binary};
  refuse(options, {std::istreambuf_iterator<char>{again}, {}});
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
  command->add_flag_callback(
      "--json", [options] { options->decode.format = TableFormat::json; },
      "Print one JSON object a line");
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
