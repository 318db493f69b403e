// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cstdio>

#include "picolo/core/version.hpp"

namespace picolo::tool {

void add_common_options(CLI::App& command, CommonOptions& options) {
  command.add_flag("--json", options.json,
                   "Print one JSON object on standard output (SI units, plain decimals)");
  command.add_option("--out", options.out, "Folder for the files that are written")
      ->capture_default_str()
      ->type_name("DIR");
  command.add_option("--config", options.config, "TOML file with settings; options given here win")
      ->type_name("FILE");
}

ExitCode end_of_input(const std::string& name, const std::string& damage) {
  if (damage.empty()) { return ExitCode::done; }
  fmt::print(stderr,
             "picolo: {}: {}; the results are those of what could be read, get a whole copy\n",
             name, damage);
  return ExitCode::input;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{"picolo: the pose of a vehicle from wheels, lidar and gyro"};
  app.name("picolo");
  app.require_subcommand(1);
  app.set_version_flag("--version",
                       fmt::format("picolo {}.{}.{}", kVersionMajor, kVersionMinor, kVersionPatch));
  app.footer(
      "Exit codes: 0 done, 1 result refused, 2 wrong usage, 3 input unreadable or without a valid\n"
      "record, 4 device or disk failed. 'picolo COMMAND --help' explains a command by examples.");
  Action action;
  add_demo(app, action);
  add_decode(app, action);
  add_run(app, action);
  add_doctor(app, action);
  add_simulate(app, action);
  add_replay(app, action);
  add_match(app, action);
  add_calibrate(app, action);
  add_undistort(app, action);
  add_evaluate(app, action);
  add_odometry3d(app, action);
  add_protocol(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? ExitCode::done : ExitCode::usage;
  }
  return action();
}

}  // namespace picolo::tool
