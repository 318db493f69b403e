// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>

#include "commands.hpp"
#include "doctor/probe.hpp"
#include "picolo/host/json.hpp"

namespace picolo::tool {
namespace {

struct Options {
  std::string can;
  std::string lidar;
  std::string imu;
  std::string config;
  bool json = false;
};

const char* word(Finding::Level level) {
  switch (level) {
    case Finding::Level::good: return "good";
    case Finding::Level::hint: return "hint";
    case Finding::Level::fault: return "fault";
  }
  return "";
}

class Report {
 public:
  explicit Report(bool json) : json_(json) {}

  void add(const std::string& name, const Findings& findings) {
    for (const Finding& finding : findings) {
      const bool fault = finding.level == Finding::Level::fault;
      faults_ += fault ? 1 : 0;
      if (json_) {
        list_.push_back({{"where", name},
                         {"level", word(finding.level)},
                         {"what", finding.what},
                         {"cure", finding.cure}});
        continue;
      }
      fmt::print("{:<6} {}: {}\n", word(finding.level), name, finding.what);
      if (!finding.cure.empty()) { fmt::print("       cure: {}\n", finding.cure); }
    }
  }
  [[nodiscard]] ExitCode finish() const {
    if (json_) {
      fmt::print("{}\n", host::to_text({{"faults", faults_}, {"findings", list_}}));
    } else {
      fmt::print("{}\n", faults_ == 0 ? "nothing wrong was found"
                                      : fmt::format("{} fault{}", faults_, faults_ > 1 ? "s" : ""));
    }
    return faults_ == 0 ? ExitCode::done : ExitCode::refused;
  }

 private:
  bool json_;
  int faults_ = 0;
  host::Json list_ = host::Json::array();
};

ExitCode doctor(const Options& options) {
  if (options.can.empty() && options.lidar.empty() && options.imu.empty()) {
    throw host::UserError{ExitCode::usage, "doctor", "was not told where to look",
                          "give --can IF, --lidar TTY, --imu TTY, or several"};
  }
  const VehicleSettings settings = read_vehicle(options.config);
  Report report{options.json};
  if (!options.can.empty()) { report.add(options.can, judge(probe_can(options.can, settings))); }
  if (!options.lidar.empty()) {
    report.add(options.lidar, judge(probe_lidar(options.lidar, settings)));
  }
  if (!options.imu.empty()) { report.add(options.imu, judge(probe_imu(options.imu, settings))); }
  return report.finish();
}

}  // namespace

void add_doctor(CLI::App& app, Action& action) {
  auto options = std::make_shared<Options>();
  CLI::App* command =
      app.add_subcommand("doctor", "Looks at bus and lines, says what is wrong and how to cure it");
  command->add_option("--can", options->can, "CAN interface, or slcan:TTY")->type_name("IF");
  command->add_option("--lidar", options->lidar, "Serial line of the lidar")->type_name("TTY");
  command->add_option("--imu", options->imu, "Serial line of the IMU")->type_name("TTY");
  command->add_option("--config", options->config, "TOML file that describes the vehicle")
      ->type_name("FILE");
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "Not while picolo run is running: two readers of a line steal each other's bytes. On the "
      "bus\n"
      "it sends one request to each wheel node, nothing else.\n"
      "Exit code 0: nothing wrong; 1: faults were found.\n"
      "\n"
      "Examples:\n"
      "  picolo doctor --can can0 --config vehicle.toml\n"
      "      down, wrong bit rate, nobody acknowledges, bus-off, a node that is missing\n"
      "  picolo doctor --lidar /dev/ttyUSB0 --imu /dev/ttyUSB1\n"
      "      permissions, no bytes, wrong baud rate (tries the others), checksum storm, latency\n");
  command->callback([&action, options] { action = [options] { return doctor(*options); }; });
}

}  // namespace picolo::tool
