// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// Any text into the readers of host programs.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "live/vehicle_settings.hpp"
#include "picolo/devices/candump.hpp"
#include "picolo/devices/dbc_file.hpp"
#include "picolo/host/carmen.hpp"
#include "picolo/host/error.hpp"
#include "picolo/host/map_file.hpp"
#include "picolo/host/trajectory.hpp"
#include "targets.hpp"

namespace picolo::fuzz {
namespace {

std::string_view text_of(Input input) {
  return {reinterpret_cast<const char*>(input.data()), input.size()};
}

/// A file in memory with this content; the same path every time.
std::string file_of(Input input, const char* extension) {
  static const char* const folder = std::getenv("PICOLO_FUZZ_FILES");
  static const std::string stem =
      (folder != nullptr ? std::string{folder} : std::string{"/dev/shm"}) + "/picolo_fuzz";
  const std::string path = stem + extension;
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) { fail("PICOLO_FUZZ_FILES names no folder that can be written"); }
  if (!input.empty()) { std::fwrite(input.data(), 1, input.size(), file); }
  std::fclose(file);
  return path;
}

void dbc_file(Input input) {
  std::vector<std::string> imports;
  const devices::DbcFile file = devices::parse_dbc(text_of(input), "fuzz.dbc", &imports);
  const std::uint8_t data[8]{1, 2, 3, 4, 5, 6, 7, 8};
  for (const devices::DbcFileMessage& message : file.messages) {
    for (const devices::DbcFileSignal& signal : message.signals) {
      const auto value = devices::dbc_value(message, signal, data);
      if (value && signal.problem.empty()) {
        require(signal.bits.valid(message.frame_bytes), "a signal past its frame was decoded");
      }
    }
  }
}

void candump(Input input) {
  std::string_view text = text_of(input);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const auto frame = devices::parse_candump(text.substr(0, end));
    if (frame) {
      require(frame->length <= 8, "a long frame");
      require(frame->id <= (frame->extended ? 0x1FFFFFFFU : 0x7FFU), "a wide identifier");
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

void log_reader(Input input) {
  const std::string path = file_of(input, ".clf");
  try {
    host::LineReader reader{path};
    host::Diagnostics diagnostics{[](std::string_view) {}};
    (void)host::read_carmen(reader, diagnostics);
  } catch (const host::UserError&) {}
}

void trajectory_reader(Input input) {
  const std::string path = file_of(input, ".tum");
  try {
    host::LineReader reader{path};
    host::Diagnostics diagnostics{[](std::string_view) {}};
    (void)host::read_tum(reader, diagnostics);
  } catch (const host::UserError&) {}
}

void configuration(Input input) {
  const std::string path = file_of(input, ".toml");
  try {
    const tool::VehicleSettings settings = tool::read_vehicle(path);
    require(settings.controller.valid(), "settings that do not fit were accepted");
    require(!settings.lidar_bauds.empty() && !settings.imu_bauds.empty(), "a line without a rate");
  } catch (const host::UserError&) {}
}

void map_file(Input input) {
  // Header text, a zero byte, picture.
  std::size_t split = 0;
  while (split < input.size() && input[split] != 0) { ++split; }
  const std::string yaml = file_of(input.first(split), ".yaml");
  file_of(input.subspan(std::min(split + 1, input.size())), ".pgm");
  try {
    (void)host::read_map(yaml);
  } catch (const host::UserError&) {}
}

}  // namespace

std::vector<Target> text_targets() {
  return {{"dbc-file", dbc_file, false},    {"candump", candump, false},
          {"log", log_reader, false},       {"trajectory", trajectory_reader, false},
          {"config", configuration, false}, {"map-file", map_file, false}};
}

}  // namespace picolo::fuzz
