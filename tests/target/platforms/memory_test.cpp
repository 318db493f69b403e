// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// Flash by module and RAM by profile of the controller image, beside the committed table; a row
// that moved by more than a tenth is committed on purpose.

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "platforms.hpp"
#include "support/data.hpp"

namespace picolo::target {
namespace {

using Table = std::map<std::string, std::uint64_t>;

/// Folder of firmware_lib, or the archive's own name.
std::string module_of(const std::string& object) {
  static const std::regex member{R"(lib(\w+)\.a\((.+?)\.(cpp\.)?o)"};
  std::smatch match;
  if (!std::regex_search(object, match, member)) { return "image"; }
  const std::string archive = match[1];
  if (archive.rfind("picolo_", 0) == 0) { return archive.substr(7); }
  if (archive != "picolo") { return "toolchain"; }
  for (const auto& folder :
       std::filesystem::directory_iterator(test::source_dir() / "firmware_lib")) {
    if (std::filesystem::exists(folder.path() / (std::string{match[2]} + ".cpp"))) {
      return folder.path().filename().string();
    }
  }
  return "unknown";
}

/// Bytes of code and constants by module, from the linker's map.
Table flash_of(const std::filesystem::path& map_file) {
  static const std::regex row{
      R"(^ (\.\S+)?\s+0x([0-9a-f]+)\s+0x([0-9a-f]+) (\S+\.(obj|o|a\(.+\)))$)"};
  std::ifstream file(map_file);
  Table flash;
  bool placed = false;
  std::string section;
  for (std::string line; std::getline(file, line);) {
    placed = placed || line.rfind("Linker script and memory map", 0) == 0;
    if (line.rfind(" .", 0) == 0) { section = line.substr(1, line.find(' ', 1) - 1); }
    std::smatch match;
    if (!placed || !std::regex_match(line, match, row)) { continue; }
    const bool in_flash = section.rfind(".text", 0) == 0 || section.rfind(".rodata", 0) == 0 ||
                          section.rfind(".vectors", 0) == 0;
    if (in_flash) { flash[module_of(match[4])] += std::stoull(match[3], nullptr, 16); }
  }
  return flash;
}

Table measured(const Platform& platform) {
  Table table;
  std::uint64_t all = 0;
  for (const auto& [module, bytes] : flash_of(build_tree(platform) / "images" / "lockstep.map")) {
    table["flash/" + module] = bytes;
    all += bytes;
  }
  table["flash/all"] = all;
  std::istringstream sizes(run(platform, "lockstep", {"sizes"}).output);
  std::string profile;
  std::uint64_t bytes = 0;
  while (sizes >> profile >> bytes) { table["ram/" + profile] = bytes; }
  return table;
}

/// Columns of the table in docs/targets.md.
const std::vector<std::string> kColumns{"target-m7", "target-m4f"};

/// Of lines `| flash/all | 92 570 | 97 360 |`: bytes, one a column.
std::map<std::string, std::vector<std::uint64_t>> committed() {
  static const std::regex line_form{R"(^\| ((?:flash|ram)/\w+) \| ([0-9 ]+) \| ([0-9 ]+) \|$)"};
  std::map<std::string, std::vector<std::uint64_t>> table;
  std::ifstream file(test::source_dir() / "docs/targets.md");
  for (std::string line; std::getline(file, line);) {
    std::smatch match;
    if (!std::regex_match(line, match, line_form)) { continue; }
    for (std::size_t column = 0; column < kColumns.size(); ++column) {
      std::string digits = match[column + 2];
      std::erase(digits, ' ');
      table[match[1]].push_back(std::stoull(digits));
    }
  }
  return table;
}

/// 92570 is 92 570.
std::string in_thousands(std::uint64_t bytes) {
  std::string text = std::to_string(bytes);
  for (int at = static_cast<int>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), " ");
  }
  return text;
}

TEST(Memory, OfModulesAndProfilesIsAsCommitted) {
  PICOLO_NEED_IMAGES();
  const auto wanted = committed();
  std::map<std::string, std::string> lines;
  for (std::size_t column = 0; column < kColumns.size(); ++column) {
    const auto judged = platforms_to_judge();
    const auto platform = std::find_if(judged.begin(), judged.end(), [&](const Platform& one) {
      return one.preset == kColumns[column];
    });
    if (platform == judged.end()) { continue; }
    const Table found = measured(*platform);
    for (const auto& [row, bytes] : found) {
      lines[row] += " " + in_thousands(bytes) + " |";
      const auto before = wanted.find(row);
      const std::uint64_t was = before == wanted.end() ? 0 : before->second[column];
      const std::uint64_t room = was / 10 + 512;
      EXPECT_TRUE(bytes <= was + room && bytes + room >= was)
          << platform->preset << ' ' << row << ": " << bytes << " bytes, docs/targets.md says "
          << was << "; its table takes the lines below";
    }
    // What the profiles promise (docs/architecture.md); stack and the port's rings come on top.
    EXPECT_LE(found.at("flash/all"), 96U * 1024);
    EXPECT_LE(found.at("ram/room"), 192U * 1024);
    EXPECT_LE(found.at("ram/hall"), 1024U * 1024);
    EXPECT_LE(found.at("ram/site"), 16U * 1024 * 1024);
  }
  for (const auto& [row, columns] : lines) { std::cout << "| " << row << " |" << columns << '\n'; }
}

}  // namespace
}  // namespace picolo::target
