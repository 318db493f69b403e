// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "decode/table.hpp"

namespace picolo::tool {
namespace {

std::string field(const host::Json& value) {
  if (value.is_null()) { return {}; }
  if (value.is_string()) { return value.get<std::string>(); }
  if (value.is_number_float()) { return host::plain_decimal(value.get<double>()); }
  return value.dump();
}

}  // namespace

SampleTable::SampleTable(std::vector<std::string> columns, TableFormat format)
    : columns_(std::move(columns)), format_(format) {
  if (format_ != TableFormat::csv) { return; }
  std::string line;
  for (const std::string& column : columns_) { line += (line.empty() ? "" : ",") + column; }
  std::puts(line.c_str());
}

void SampleTable::row(const std::vector<host::Json>& values) {
  ++rows_;
  if (format_ == TableFormat::nothing) { return; }
  if (format_ == TableFormat::json) {
    host::Json line = host::Json::object();
    for (std::size_t i = 0; i < columns_.size(); ++i) { line[columns_[i]] = values.at(i); }
    std::puts(line.dump().c_str());
    return;
  }
  std::string line;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0) { line += ','; }
    line += field(values[i]);
  }
  std::puts(line.c_str());
}

}  // namespace picolo::tool
