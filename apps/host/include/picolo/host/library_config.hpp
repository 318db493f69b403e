// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The library's configuration structs from a configuration file: every field by its own name.
#pragma once

#include <string>

#include "picolo/host/config_file.hpp"
#include "picolo/localisation/localiser.hpp"

namespace picolo::host {

/// [SECTION] and its sub-sections map, coarse, fine, noise, search, heading. Throws UserError
/// (usage) when a value has the wrong type, or the result is not valid().
void read(ConfigFile& file, const std::string& section, LocaliserConfig& config);

}  // namespace picolo::host
