// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "system_calls.hpp"

#include <signal.h>  // NOLINT(modernize-deprecated-headers): raise
#include <sys/ptrace.h>
#include <sys/wait.h>
#include <unistd.h>

namespace picolo::test {

std::optional<int> system_calls_of(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child == 0) {
    if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) { ::_exit(9); }
    ::raise(SIGSTOP);
    work();
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (!WIFSTOPPED(status)) { return std::nullopt; }
  int stops = 0;
  while (::ptrace(PTRACE_SYSCALL, child, nullptr, nullptr) == 0) {
    if (::waitpid(child, &status, 0) != child || WIFEXITED(status) || WIFSIGNALED(status)) {
      break;
    }
    ++stops;
  }
  return stops / 2;  // one stop on the way in, one on the way out
}

}  // namespace picolo::test
