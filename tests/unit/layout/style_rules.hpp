// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What can be checked of the style from the text of the sources.
#pragma once

#include <vector>

#include "source_tree.hpp"

namespace picolo::layout {

/// Two SPDX lines, at most 400 lines of at most 100 columns, #pragma once in headers.
std::vector<Violation> form_violations(const SourceFile& file);
/// The two SPDX lines of a build file or script, after an optional #! line.
std::vector<Violation> licence_violations(const SourceFile& file);
/// Names that must not occur in what runs on the target: heap, exceptions, RTTI, heavy std types.
std::vector<Violation> poisoned_names(const SourceFile& file);
/// Arithmetic on quantities (names with a unit, float literals) in a public header, outside of
/// constexpr: it would be compiled with a customer's flags. A heuristic over single lines.
std::vector<Violation> header_arithmetic(const SourceFile& file);

}  // namespace picolo::layout
