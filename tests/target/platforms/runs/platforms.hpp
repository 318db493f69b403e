// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Where images run: the presets of CMakePresets.json that build them, and what starts their
/// programs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace picolo::target {

struct Platform {
  std::string name;     ///< for people
  std::string preset;   ///< its build tree is build/PRESET
  std::string machine;  ///< of QEMU; empty: runs here or under qemu-user
  std::string program;  ///< what must be installed to run it; empty: nothing

  /// Doubles are computed in software: the images have bounds of work of their own.
  [[nodiscard]] bool software_doubles() const { return preset == "target-m4f"; }
};

/// All of them, in the order of the tables.
const std::vector<Platform>& platforms();

/// Those that were built for this run: named in PICOLO_TARGETS (presets, comma between; `all`), or,
/// without it, those whose images are there.
std::vector<Platform> platforms_to_judge();
/// Why no image can be judged, for skips; empty when one can.
std::string nothing_to_judge();

std::filesystem::path image(const Platform& platform, const std::string& name);
std::filesystem::path build_tree(const Platform& platform);

struct Outcome {
  int status = -1;
  std::string output;
  double seconds = 0.0;
};

/// What an image tells as lines of a name and a number.
using Figures = std::map<std::string, std::int64_t>;
Figures figures_in(const std::string& text);

/// Runs a command and keeps what it says on both outputs.
Outcome run(const std::string& command);
/// Runs an image with words for its command line. `extra`: more options of QEMU's.
Outcome run(const Platform& platform, const std::string& image_name,
            const std::vector<std::string>& words = {}, const std::string& extra = "");

/// PICOLO_REQUIRE names `arm`: what would be skipped fails.
bool required();

}  // namespace picolo::target

/// First line of tests that need images.
#define PICOLO_NEED_IMAGES()                                                   \
  do {                                                                         \
    const std::string reason = ::picolo::target::nothing_to_judge();           \
    if (!reason.empty() && ::picolo::target::required()) { FAIL() << reason; } \
    if (!reason.empty()) { GTEST_SKIP() << reason; }                           \
  } while (false)
