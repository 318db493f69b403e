// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// The archives of every platform refer to nothing that a board has not; on a Cortex-M4F, where a
// double is computed in software, only the files of the double list compute in doubles.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "platforms.hpp"
#include "support/data.hpp"
#include "symbol_rules.hpp"

namespace picolo::target {
namespace {

constexpr const char* kArchives[] = {"firmware_lib/libpicolo.a",
                                     "drivers/libpicolo_drivers.a",
                                     "controller/libpicolo_controller.a",
                                     "ports/sim/libpicolo_port_sim.a",
                                     "ports/template/libpicolo_port_template.a",
                                     "ports/board/libpicolo_port_board.a"};
// Of one board each.
constexpr const char* kBoardArchives[] = {"ports/zcu102/libpicolo_port_zcu102.a"};

/// What there is in the build tree.
std::vector<std::string> archives_of(const Platform& platform) {
  std::vector<std::string> archives{std::begin(kArchives), std::end(kArchives)};
  for (const char* archive : kBoardArchives) {
    if (std::filesystem::exists(build_tree(platform) / archive)) { archives.emplace_back(archive); }
  }
  return archives;
}

/// What CMake found for the platform's compiler.
std::string nm_of(const Platform& platform) {
  std::ifstream cache(build_tree(platform) / "CMakeCache.txt");
  for (std::string line; std::getline(cache, line);) {
    if (line.rfind("CMAKE_NM:", 0) == 0) { return line.substr(line.find('=') + 1); }
  }
  return "nm";
}

TEST(Symbols, OfEveryPlatformAreAllowed) {
  PICOLO_NEED_IMAGES();
  for (const Platform& platform : platforms_to_judge()) {
    std::size_t seen = 0;
    for (const std::string& archive : archives_of(platform)) {
      const std::string file = (build_tree(platform) / archive).string();
      const Outcome listing = run(nm_of(platform) + " --format=sysv " + file);
      EXPECT_EQ(listing.status, 0) << listing.output;
      for (const layout::Symbol& symbol : layout::parse_symbols(listing.output)) {
        ++seen;
        EXPECT_EQ(layout::symbol_violation(symbol), "")
            << platform.name << ", " << archive << ": " << symbol.name;
      }
    }
    EXPECT_GT(seen, 1000U) << platform.name;
    std::cout << "| " << platform.name << " | " << seen << " symbols, none forbidden |\n";
  }
}

/// Member of an archive without its endings -> the helpers of the run-time library that it calls.
std::map<std::string, std::set<std::string>> double_helpers(const Platform& platform) {
  static const std::regex row{R"(\[(.+?)\.cpp\.obj\]: (\S+) U)"};
  static const std::regex helper{R"(__aeabi_(d\w+|c?d\w+|(f|i|ui|l|ul)2d)|sqrt)"};
  std::map<std::string, std::set<std::string>> found;
  for (const char* archive : kArchives) {
    // The simulation is a world for hosts and tests; its physics is in doubles.
    if (std::string{archive}.rfind("ports/sim", 0) == 0) { continue; }
    const Outcome listing =
        run(nm_of(platform) + " -A -u --format=posix " + (build_tree(platform) / archive).string());
    std::istringstream lines(listing.output);
    for (std::string line; std::getline(lines, line);) {
      std::smatch match;
      if (!std::regex_search(line, match, row)) { continue; }
      const std::string symbol = match[2];
      if (std::regex_match(symbol, helper)) { found[match[1]].insert(symbol); }
    }
  }
  return found;
}

TEST(Symbols, OfCortexM4FComputeInDoublesOnlyInFilesOfTheDoubleList) {
  PICOLO_NEED_IMAGES();
  std::map<std::string, std::string> allowed;
  std::ifstream list(test::source_dir() / "toolchain/double_list.txt");
  for (std::string line; std::getline(list, line);) {
    std::istringstream words(line);
    std::string file;
    if (words >> file && file[0] != '#') { std::getline(words, allowed[file]); }
  }
  ASSERT_FALSE(allowed.empty());
  bool judged = false;
  for (const Platform& platform : platforms_to_judge()) {
    if (platform.preset != "target-m4f") { continue; }
    judged = true;
    const auto found = double_helpers(platform);
    for (const auto& [file, helpers] : found) {
      EXPECT_TRUE(allowed.contains(file))
          << file << ".cpp computes in doubles (" << *helpers.begin()
          << ", ...): make it float, or give it a line with its reason in "
             "toolchain/double_list.txt";
    }
    for (const auto& [file, reason] : allowed) {
      EXPECT_TRUE(found.contains(file)) << file << " is on the double list without need";
      EXPECT_GT(reason.size(), 8U) << file << " is on the double list without a reason";
    }
  }
  if (!judged) { std::cout << "target-m4f was not asked for\n"; }
}

}  // namespace
}  // namespace picolo::target
