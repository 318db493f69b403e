// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

// What the pages say is so: the README's program is the example that the tests run, and links lead
// somewhere.

#include <gtest/gtest.h>

#include "support/paths.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

#include "support/paths.hpp"

namespace picolo::layout {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream stream{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{stream}, std::istreambuf_iterator<char>{}};
}

/// What stands between two markers; empty when one is missing.
std::string between_markers(const std::string& text, const std::string& begin,
                            const std::string& end) {
  const std::size_t from = text.find(begin);
  if (from == std::string::npos) { return ""; }
  const std::size_t start = from + begin.size();
  const std::size_t to = text.find(end, start);
  return to == std::string::npos ? "" : text.substr(start, to - start);
}

/// Link targets of a page that are files of the tree, without their #anchors.
std::vector<std::string> local_links(const std::string& page) {
  static const std::regex link{R"re(\]\(([^)#\s]+)[^)]*\))re"};
  std::vector<std::string> targets;
  for (std::sregex_iterator match{page.begin(), page.end(), link}, end; match != end; ++match) {
    const std::string target = (*match)[1];
    if (target.find("://") == std::string::npos) { targets.push_back(target); }
  }
  return targets;
}

TEST(Readme, ItsProgramIsTheExampleThatTheTestsRun) {
  const fs::path root = test::source_dir();
  const std::string shown = between_markers(
      read(root / "README.md"), "<!-- examples/readme_example/main.cpp -->\n```cpp\n", "```\n");
  const std::string compiled = between_markers(read(root / "examples/readme_example/main.cpp"),
                                               "// README: begin\n", "// README: end\n");
  ASSERT_FALSE(compiled.empty());
  EXPECT_EQ(shown, compiled) << "copy the marked lines of examples/readme_example/main.cpp";
}

TEST(Docs, EveryLinkIntoTheTreeLeadsSomewhere) {
  const fs::path root = test::source_dir();
  std::vector<fs::path> pages{root / "README.md", root / "CONTRIBUTING.md", root / "CHANGELOG.md"};
  for (const auto& entry : fs::recursive_directory_iterator{root / "docs"}) {
    if (entry.path().extension() == ".md") { pages.push_back(entry.path()); }
  }
  int links = 0;
  for (const fs::path& page : pages) {
    for (const std::string& target : local_links(read(page))) {
      ++links;
      EXPECT_TRUE(fs::exists(page.parent_path() / target)) << page << " links to " << target;
    }
  }
  EXPECT_GT(links, 10);
}

TEST(DocsCheck, FindsLinksAndMarkedText) {
  const auto links = local_links("[a](b.md) ![p](docs/p.png) [c](https://x.org/y) [d](e.md#part)");
  EXPECT_EQ(links, (std::vector<std::string>{"b.md", "docs/p.png", "e.md"}));
  EXPECT_EQ(between_markers("x BEGIN y END z", "BEGIN", "END"), " y ");
  EXPECT_EQ(between_markers("x BEGIN y", "BEGIN", "END"), "");
}

}  // namespace
}  // namespace picolo::layout
