// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Where the sources and the recorded data lie on this machine.
#pragma once

#include <filesystem>

namespace picolo::test {

std::filesystem::path source_dir();
std::filesystem::path data_dir();

}  // namespace picolo::test
