// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "symbol_rules.hpp"

#include <regex>
#include <sstream>

namespace picolo::layout {
namespace {

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' ');
  if (begin == std::string::npos) { return ""; }
  return text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

bool starts_with(const std::string& text, const std::string& start) {
  return text.rfind(start, 0) == 0;
}

}  // namespace

std::vector<Symbol> parse_symbols(const std::string& nm_output) {
  std::vector<Symbol> symbols;
  std::istringstream stream{nm_output};
  for (std::string line; std::getline(stream, line);) {
    std::vector<std::string> cells;  // name, value, class, type, size, line, section
    std::istringstream row{line};
    for (std::string cell; std::getline(row, cell, '|');) { cells.push_back(trimmed(cell)); }
    if (cells.size() < 6 || cells[0] == "Name") { continue; }
    const std::size_t bytes = cells[4].empty() ? 0 : std::stoul(cells[4], nullptr, 16);
    symbols.push_back({cells[0], cells[2], cells.size() > 6 ? cells[6] : "", bytes});
  }
  return symbols;
}

std::string symbol_violation(const Symbol& symbol) {
  static const std::regex deny{
      R"re(malloc|calloc|realloc|\bfree\b|_sbrk|_Zn[wa]|_Zd[la]|_Unwind|__throw|terminate)re"
      R"re(|__cxa_(throw|guard|allocate|atexit)|locale|ostream|printf|__assert|\babort\b)re"};
  static const std::regex libm{
      R"re((a?(sin|cos|tan)h?|atan2|sincos|exp2?|expm1|log(2|10|1p)?|pow|hypot|cbrt|sqrt)[fl]?)re"
      R"re(|(floor|ceil|l?l?round|trunc|l?l?rint|nearbyint|fmod|remainder|fma|fmin|fmax)[fl]?)re"};
  const bool own = symbol.name.find("6picolo") != std::string::npos;
  if (symbol.kind == "U") {
    if (own) { return ""; }
    if (std::regex_search(symbol.name, deny)) { return "is on the deny list"; }
    if (std::regex_match(symbol.name, libm)) { return "is libm: its bits differ by platform"; }
    return "";
  }
  if (starts_with(symbol.name, "_ZGV")) { return "guards a function-local static"; }
  if (starts_with(symbol.name, "_ZTI")) { return "is run-time type information"; }
  const bool writable =
      (starts_with(symbol.section, ".data") && !starts_with(symbol.section, ".data.rel.ro")) ||
      starts_with(symbol.section, ".bss");
  const bool index_name_of_eigen =
      starts_with(symbol.name, "_ZN13EigenOfPicoloL") && symbol.bytes <= 2;
  return writable && !index_name_of_eigen
             ? "is writable static storage: the application owns all memory"
             : "";
}

}  // namespace picolo::layout
