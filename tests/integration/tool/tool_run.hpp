// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Starts the picolo command and keeps what it said.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "picolo/host/json.hpp"
#include "support/files.hpp"

namespace picolo::test {

struct ToolRun {
  int exit_code = -1;
  std::string out;
  std::string err;

  [[nodiscard]] host::Json json() const { return host::Json::parse(out); }
};

inline std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) { text += c == '\'' ? std::string{"'\\''"} : std::string{c}; }
  return text + "'";
}

/// In the folder, so that the default ./picolo-out lands there. `input` is a file for standard
/// input.
inline ToolRun run_tool(const TemporaryFolder& folder, const std::vector<std::string>& arguments,
                        const std::string& input = "/dev/null") {
  std::string line = "cd " + quoted(folder.path().string()) + " && " + quoted(PICOLO_TOOL);
  for (const std::string& argument : arguments) { line += " " + quoted(argument); }
  line += " <" + quoted(input) + " >tool.out 2>tool.err";
  const int status = std::system(line.c_str());  // NOLINT(concurrency-mt-unsafe,cert-env33-c)
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(folder.path() / "tool.out"),
          content_of(folder.path() / "tool.err")};
}

}  // namespace picolo::test
