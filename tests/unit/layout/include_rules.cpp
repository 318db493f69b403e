// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "include_rules.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "support/paths.hpp"

namespace picolo::layout {
namespace {

using Names = std::set<std::string>;

/// Who may see whom, by the second part of an include path: picolo/NAME/...
/// Folders of firmware_lib always see themselves.
const std::map<std::string, Names>& firmware_table() {
  static const Names ground{"core", "geometry", "sensing"};
  static const Names below_matching{"core", "geometry", "sensing", "map", "solve", "undistort"};
  static const Names above_odometry{"core",  "geometry",  "sensing",  "map",
                                    "solve", "undistort", "matching", "odometry"};
  static const Names below_odometry{"core",  "geometry",  "sensing", "map",
                                    "solve", "undistort", "matching"};
  static const std::map<std::string, Names> table{
      {"core", {}},
      {"geometry", {"core"}},
      {"sensing", {"core"}},
      {"map", ground},
      {"solve", ground},
      {"undistort", ground},
      {"matching", below_matching},
      {"odometry", below_odometry},
      {"localisation", above_odometry},
      {"calibration", above_odometry},
      {"evaluation", {"core", "geometry"}},
      {"executive", {"core"}},
  };
  return table;
}

/// STYLE: "Allowed in the library". <chrono> and <atomic> have one home each.
const Names& allowed_std_headers() {
  static const Names headers{"algorithm", "array",   "bit",         "cfloat", "cmath",   "concepts",
                             "cstddef",   "cstdint", "cstring",     "limits", "numbers", "optional",
                             "ratio",     "span",    "type_traits", "utility"};
  return headers;
}

const std::multimap<std::string, std::string>& std_headers_with_a_home() {
  static const std::multimap<std::string, std::string> homes{
      {"chrono", "firmware_lib/core/include/picolo/core/time.hpp"},
      {"atomic", "firmware_lib/core/include/picolo/core/ring_buffer.hpp"},
      {"immintrin.h", "firmware_lib/map/kernel/picolo/map/bilinear_lanes.hpp"},  // with AVX2 only
      {"memory", "controller/c_facade.cpp"},  // std::construct_at in memory of the caller, ...
      // ... and in memory that two searches share
      {"memory", "firmware_lib/localisation/include/picolo/localisation/search_memory.hpp"},
  };
  return homes;
}

std::string part(const std::string& path, std::size_t index) {
  std::size_t begin = 0;
  for (; index > 0; --index) {
    const std::size_t slash = path.find('/', begin);
    if (slash == std::string::npos) { return ""; }
    begin = slash + 1;
  }
  const std::size_t end = path.find('/', begin);
  return end == std::string::npos ? "" : path.substr(begin, end - begin);
}

bool is_os_or_vendor(const std::string& header) {
  return header.find('/') != std::string::npos || header.find('.') != std::string::npos;
}

std::string check_system(const SourceFile& file, const std::string& header) {
  const bool eigen = starts_with_folder(header, "Eigen");
  const bool in_ports = starts_with_folder(file.path, "ports");
  if (!is_firmware(file)) {
    if (in_ports && is_header(file) && is_os_or_vendor(header) && !eigen) {
      return "OS and vendor headers belong into the port's .cpp files";
    }
    return "";
  }
  if (eigen) {
    if (!starts_with_folder(file.path, "firmware_lib")) { return "Eigen is for firmware_lib only"; }
    if (starts_with_folder(file.path, "firmware_lib/core")) { return "core does without Eigen"; }
    return is_public_header(file) ? "Eigen stays out of public headers" : "";
  }
  const auto [first, last] = std_headers_with_a_home().equal_range(header);
  if (first != last) {
    const bool at_home =
        std::any_of(first, last, [&](const auto& home) { return home.second == file.path; });
    return at_home ? "" : "this header is included in " + first->second + " only";
  }
  if (is_os_or_vendor(header)) { return "OS and vendor headers are for ports"; }
  return allowed_std_headers().contains(header) ? "" : "not on the list of allowed std headers";
}

/// `seen` is NAME of picolo/NAME/...; hal, drivers, controller and the ports have names of their
/// own.
std::string check_layer(const SourceFile& file, const std::string& target) {
  const std::string top = part(file.path, 0);
  const std::string own = part(file.path, 1);
  const bool facade = target == "picolo/picolo.h";  // the C face of the controller
  const std::string seen = facade ? "controller" : part(target, 1);
  const bool seen_is_firmware = firmware_table().contains(seen);
  if (top == "firmware_lib") {
    const auto row = firmware_table().find(own);
    if (row == firmware_table().end()) { return "folder is not in the include table"; }
    const bool allowed = seen == own || row->second.contains(seen);
    return allowed ? "" : "firmware_lib/" + own + " must not see " + seen;
  }
  if (top == "hal") {
    return seen == "core" || seen == "hal" ? "" : "hal sees core only, not " + seen;
  }
  if (top == "drivers") {
    if (seen == "core" || seen == "sensing" || seen == "hal") { return ""; }
    const std::string device = part(target, 2);
    if (seen == "drivers" && (device == own || device == "common")) { return ""; }
    return "a driver sees core, sensing, hal, itself and drivers/common, not " + seen +
           (seen == "drivers" ? "/" + device : "");
  }
  if (top == "controller") {
    const bool allowed =
        seen_is_firmware || seen == "hal" || seen == "drivers" || seen == "controller";
    return allowed ? "" : "the controller must not see the port " + seen;
  }
  if (top == "ports") {
    if (seen == "core" || seen == "sensing" || seen == "hal" || seen == own) { return ""; }
    if (own == "sim" && seen_is_firmware) { return ""; }
    if (seen == "board") { return ""; }  // what boards share
    return "port " + own + " sees core, sensing, hal, board and itself, not " + seen;
  }
  return "";
}

std::string check_quoted(const SourceFile& file, const std::string& target) {
  if (target.find("..") != std::string::npos) { return "includes start at the include root"; }
  if (starts_with_folder(target, "picolo")) {
    const std::string layer = check_layer(file, target);
    if (!layer.empty() || !is_public_header(file)) { return layer; }
    const std::filesystem::path kernel =
        test::source_dir() / "firmware_lib" / part(target, 1) / "kernel" / target;
    return std::filesystem::exists(kernel) ? "a public header must not see a kernel" : "";
  }
  if (!is_firmware(file) && !starts_with_folder(file.path, "ports")) { return ""; }
  if (is_public_header(file)) { return "a public header includes public headers only"; }
  const std::filesystem::path beside = (test::source_dir() / file.path).parent_path() / target;
  return std::filesystem::exists(beside) ? "" : "a private header lies beside its users";
}

}  // namespace

std::vector<Violation> include_violations(const SourceFile& file) {
  std::vector<Violation> violations;
  for (const Include& include : file.includes) {
    const std::string rule =
        include.system ? check_system(file, include.target) : check_quoted(file, include.target);
    if (!rule.empty()) {
      violations.push_back({file.path, include.line, include.target + ": " + rule});
    }
  }
  return violations;
}

}  // namespace picolo::layout
