// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The TOML file behind `--config`: the fields of the library's configuration structs by name.
#pragma once

#include <toml++/toml.h>
#include <filesystem>
#include <set>
#include <string>

namespace picolo::host {

class ConfigFile {
 public:
  /// An empty path is a file without keys. Throws UserError: input when it cannot be read, usage
  /// when it is not TOML.
  explicit ConfigFile(const std::filesystem::path& path);

  /// Replaces `value` when `[section]` holds `key`; a section may be nested ("a.b").
  /// Throws UserError (usage) naming file and line when the type or range does not fit.
  void read(const std::string& section, const std::string& key, bool& value);
  void read(const std::string& section, const std::string& key, int& value);
  void read(const std::string& section, const std::string& key, float& value);
  void read(const std::string& section, const std::string& key, double& value);
  void read(const std::string& section, const std::string& key, std::string& value);

  /// Throws UserError (usage) for the first key that nobody asked for: a typing error must not
  /// silently leave a default in place. `other_sections` belong to other commands.
  void reject_unknown(const std::set<std::string>& other_sections = {}) const;

 private:
  [[nodiscard]] const toml::node* find(const std::string& section, const std::string& key);
  [[noreturn]] void refuse(const toml::node& node, const std::string& key,
                           const std::string& expected) const;
  void reject_unknown_in(const toml::table& table, const std::string& section,
                         const std::set<std::string>& other_sections) const;

  std::string name_;
  toml::table root_;
  std::set<std::string> asked_;
};

}  // namespace picolo::host
