// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Picolo commands that run beside a test.
#pragma once

#include <signal.h>  // NOLINT(modernize-deprecated-headers): kill
#include <sys/wait.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "tool_run.hpp"

namespace picolo::test {

/// A picolo process in the background, with its output in a file.
class Process {
 public:
  Process(const TemporaryFolder& folder, const std::string& name,
          const std::vector<std::string>& arguments)
      : name_(folder.file(name)) {
    std::string line =
        "cd " + test::quoted(folder.path().string()) + " && exec " + test::quoted(PICOLO_TOOL);
    for (const std::string& argument : arguments) { line += " " + test::quoted(argument); }
    line += " >" + test::quoted(name_ + ".out") + " 2>" + test::quoted(name_ + ".err");
    pid_ = ::fork();
    if (pid_ == 0) {
      ::execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    }
  }
  ~Process() { stop(SIGKILL); }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  [[nodiscard]] pid_t pid() const { return pid_; }
  /// Exit code; -1 when a signal ended it.
  int stop(int signal) {
    if (pid_ <= 0) { return -1; }
    ::kill(pid_, signal);
    return wait();
  }
  int wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  [[nodiscard]] std::string out() const { return test::content_of(name_ + ".out"); }
  [[nodiscard]] std::string err() const { return test::content_of(name_ + ".err"); }

 private:
  std::string name_;
  pid_t pid_ = -1;
};

}  // namespace picolo::test
