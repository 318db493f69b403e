// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Files the tool writes: opened, checked and closed in one place.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace picolo::host {

/// Creates the folder and its parents. Throws UserError (usage) when that cannot be done.
void make_folder(const std::filesystem::path& path);

/// Replaces the file's content. Throws UserError: usage when it cannot be opened, device when
/// writing fails (a full disk).
void write_file(const std::filesystem::path& path, std::string_view content);

/// The file's content. Throws UserError (input) with this cure: also for a folder, which a stream
/// would open, and then throw or be empty.
[[nodiscard]] std::string read_file(const std::filesystem::path& path,
                                    const std::string& cure = "check the path");

}  // namespace picolo::host
