// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/config_file.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <limits>

#include "picolo/host/error.hpp"
#include "picolo/host/files.hpp"

namespace picolo::host {

ConfigFile::ConfigFile(const std::filesystem::path& path) : name_{path.string()} {
  if (path.empty()) { return; }
  const std::string text = read_file(path, "check the path given to --config");
  try {
    root_ = toml::parse(text, name_);
  } catch (const toml::parse_error& error) {
    throw UserError{ExitCode::usage, fmt::format("{}:{}", name_, error.source().begin.line),
                    std::string{error.description()}, "the file must be valid TOML"};
  }
}

const toml::node* ConfigFile::find(const std::string& section, const std::string& key) {
  const std::string full = section.empty() ? key : section + "." + key;
  asked_.insert(full);
  return root_.at_path(full).node();
}

void ConfigFile::refuse(const toml::node& node, const std::string& key,
                        const std::string& expected) const {
  throw UserError{ExitCode::usage, fmt::format("{}:{}", name_, node.source().begin.line),
                  "'" + key + "' has the wrong type", "give " + expected};
}

void ConfigFile::read(const std::string& section, const std::string& key, bool& value) {
  if (const toml::node* node = find(section, key)) {
    if (!node->is_boolean()) { refuse(*node, key, "true or false"); }
    value = node->as_boolean()->get();
  }
}

void ConfigFile::read(const std::string& section, const std::string& key, int& value) {
  if (const toml::node* node = find(section, key)) {
    const std::int64_t wide =
        node->value_exact<std::int64_t>().value_or(std::numeric_limits<std::int64_t>::max());
    if (wide < std::numeric_limits<int>::min() || wide > std::numeric_limits<int>::max()) {
      refuse(*node, key, "a whole number");
    }
    value = static_cast<int>(wide);
  }
}

void ConfigFile::read(const std::string& section, const std::string& key, double& value) {
  if (const toml::node* node = find(section, key)) {
    if (!node->is_number()) { refuse(*node, key, "a number"); }
    value = node->value<double>().value_or(value);
  }
}

void ConfigFile::read(const std::string& section, const std::string& key, float& value) {
  auto wide = static_cast<double>(value);
  read(section, key, wide);
  value = static_cast<float>(wide);
}

void ConfigFile::read(const std::string& section, const std::string& key, std::string& value) {
  if (const toml::node* node = find(section, key)) {
    if (!node->is_string()) { refuse(*node, key, "a string"); }
    value = node->as_string()->get();
  }
}

void ConfigFile::reject_unknown(const std::set<std::string>& other_sections) const {
  reject_unknown_in(root_, "", other_sections);
}

void ConfigFile::reject_unknown_in(const toml::table& table, const std::string& section,
                                   const std::set<std::string>& other_sections) const {
  for (const auto& [key, node] : table) {
    const std::string full =
        (section.empty() ? "" : section + ".") + std::string{std::string_view{key}};
    if (other_sections.count(full) > 0) { continue; }
    if (const toml::table* below = node.as_table()) {
      reject_unknown_in(*below, full, other_sections);
    } else if (asked_.count(full) == 0) {
      throw UserError{ExitCode::usage, fmt::format("{}:{}", name_, node.source().begin.line),
                      "unknown key '" + full + "'", "remove it or correct its spelling"};
    }
  }
}

}  // namespace picolo::host
