// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the objects of the static libraries may refer to and must not contain.
#pragma once

#include <string>
#include <vector>

namespace picolo::layout {

struct Symbol {
  std::string name;
  std::string kind;     ///< nm's letter; U is a reference to something outside
  std::string section;  ///< empty for references
};

/// From the output of `nm --format=sysv`.
std::vector<Symbol> parse_symbols(const std::string& nm_output);

/// Why the symbol must not be there; empty when it may. Heap, exceptions, RTTI, libm, stdio, atexit
/// as references; writable statics (.data, .bss) and guarded statics as definitions.
std::string symbol_violation(const Symbol& symbol);

}  // namespace picolo::layout
