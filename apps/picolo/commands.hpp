// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The commands of the picolo tool: each adds itself to the command line and runs.
#pragma once

#include <functional>
#include <string>

#include "picolo/host/error.hpp"

namespace CLI {
class App;
}

namespace picolo::tool {

using host::ExitCode;

/// Parses the command line and runs the command it names. Throws host::UserError.
ExitCode run(int argc, char** argv);

/// What every command takes.
struct CommonOptions {
  bool json = false;
  std::string out = "picolo-out";
  std::string config;
};
void add_common_options(CLI::App& command, CommonOptions& options);

/// How a command ends whose input was read to its end, or to where it is damaged (with a message).
ExitCode end_of_input(const std::string& name, const std::string& damage);

/// Adds the command; when the command line names it, `action` is set to what is to be done.
using Action = std::function<ExitCode()>;
void add_decode(CLI::App& app, Action& action);
void add_demo(CLI::App& app, Action& action);
void add_replay(CLI::App& app, Action& action);
void add_match(CLI::App& app, Action& action);
void add_undistort(CLI::App& app, Action& action);
void add_evaluate(CLI::App& app, Action& action);
void add_odometry3d(CLI::App& app, Action& action);
void add_calibrate(CLI::App& app, Action& action);
void add_protocol(CLI::App& app, Action& action);
void add_run(CLI::App& app, Action& action);
void add_doctor(CLI::App& app, Action& action);
void add_simulate(CLI::App& app, Action& action);

}  // namespace picolo::tool
