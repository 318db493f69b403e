// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// The include table of docs/architecture.md, as a function.
#pragma once

#include <string>
#include <vector>

#include "source_tree.hpp"

namespace picolo::layout {

/// What is wrong with the includes of one file; empty when all is well.
std::vector<Violation> include_violations(const SourceFile& file);

}  // namespace picolo::layout
