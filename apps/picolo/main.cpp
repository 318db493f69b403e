// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <exception>

#include "commands.hpp"
#include "picolo/host/error.hpp"

int main(int argc, char** argv) {
  using picolo::host::ExitCode;
  try {
    return static_cast<int>(picolo::tool::run(argc, argv));
  } catch (const picolo::host::UserError& error) {
    fmt::print(stderr, "picolo: {}\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    fmt::print(stderr, "picolo: internal error: {}; please report this\n", error.what());
    return static_cast<int>(ExitCode::device);
  }
}
