// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// One number a drive, whatever computed it: the table of every platform against the committed file.

#include <gtest/gtest.h>

#include <fstream>
#include <iostream>
#include <map>
#include <sstream>
#include <string>

#include "platforms.hpp"
#include "support/data.hpp"

namespace picolo::target {
namespace {

using Hashes = std::map<std::string, std::string>;

Hashes read(std::istream& stream) {
  Hashes hashes;
  for (std::string line; std::getline(stream, line);) {
    std::istringstream words(line);
    std::string name;
    std::string value;
    if (words >> name >> value && name[0] != '#') { hashes[name] = value; }
  }
  return hashes;
}

Hashes committed() {
  std::ifstream file(test::source_dir() / "tests/integration/hashes/hashes.txt");
  return read(file);
}

constexpr const char* kCases[] = {"sim/office", "sim/corridor", "sim/hall", "sim3d/yard",
                                  "arithmetic/ieee754"};

void judge(const Platform& platform, const std::string& image_name, const std::string& title) {
  const Outcome outcome = run(platform, image_name);
  EXPECT_EQ(outcome.status, 0) << title << ": " << outcome.output;
  std::istringstream lines(outcome.output);
  const Hashes found = read(lines);
  const Hashes wanted = committed();
  std::cout << "| " << title << std::string(title.size() < 34 ? 34 - title.size() : 0, ' ');
  for (const char* name : kCases) {
    const auto value = found.find(name);
    const std::string hash = value == found.end() ? "(none)" : value->second;
    EXPECT_EQ(hash, wanted.at(name)) << title << ", " << name;
    std::cout << " | " << hash << (hash == wanted.at(name) ? "" : " DIFFERS");
  }
  std::cout << " | " << outcome.seconds << " s |\n" << std::flush;
}

TEST(OneHash, IsWhatEveryPlatformFinds) {
  PICOLO_NEED_IMAGES();
  std::cout << "| platform                          ";
  for (const char* name : kCases) { std::cout << " | " << name; }
  std::cout << " | run |\n|---|---|---|---|---|---|---|\n";
  for (const Platform& platform : platforms_to_judge()) {
    judge(platform, "determinism", platform.name);
    if (platform.machine.empty()) {
      // Linked into a program built with fused multiply-adds and vectorised Eigen.
      judge(platform, "hostile", platform.name + ", hostile consumer");
    }
  }
}

}  // namespace
}  // namespace picolo::target
