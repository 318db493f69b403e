// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the objects of the static libraries may refer to and must not contain.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace picolo::layout {

struct Symbol {
  std::string name;
  std::string kind;     ///< nm's letter; U is a reference to something outside
  std::string section;  ///< empty for references
  std::size_t bytes = 0;
};

/// From the output of `nm --format=sysv`.
std::vector<Symbol> parse_symbols(const std::string& nm_output);

/// Why the symbol must not be there; empty when it may. Heap, exceptions, RTTI, libm, stdio, atexit
/// as references; writable statics (.data, .bss) and guarded statics as definitions. Eigen's names
/// for indices (`last`, `all`) are empty objects that only -O0 keeps: they hold no state.
std::string symbol_violation(const Symbol& symbol);

}  // namespace picolo::layout
