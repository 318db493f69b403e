// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "commands.hpp"
#include "picolo/controller/controller_config.hpp"
#include "picolo/host/can_protocol.hpp"

namespace picolo::tool {
namespace {

struct Options {
  bool dbc = false;
  bool tables = false;
  int base_id = FramesOutConfig{}.base_id;
};

ExitCode protocol(const Options& options) {
  const FramesOutConfig config{.base_id = static_cast<std::uint16_t>(options.base_id)};
  if (!config.valid()) {
    throw host::UserError{ExitCode::usage, "--base",
                          fmt::format("0x{:X} cannot be a base identifier", options.base_id),
                          "give a multiple of 16 up to 0x7E0"};
  }
  const bool both = options.dbc == options.tables;
  if (options.dbc || both) { fmt::print("{}", host::can_dbc(config.base_id)); }
  if (options.tables || both) { fmt::print("{}", host::can_tables(config.base_id)); }
  return ExitCode::done;
}

}  // namespace

void add_protocol(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("protocol", "Prints the controller's CAN protocol: a DBC file, tables");
  command->add_flag("--dbc", options->dbc, "The DBC file");
  command->add_flag("--tables", options->tables, "Tables for people, Markdown");
  command->add_option("--base", options->base_id, "Base identifier, as in [can] of the controller")
      ->check(CLI::Range(0, 0x7E0))
      ->type_name("ID");
  command->footer(
      "Examples:\n"
      "  picolo protocol --dbc > picolo.dbc\n"
      "  picolo protocol --dbc --base 0x140 > second_vehicle.dbc\n"
      "  picolo protocol --tables\n");
  command->callback([&action, options] { action = [options] { return protocol(*options); }; });
}

}  // namespace picolo::tool
