// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Samples as lines: CSV with one header line, or a JSON object a line.
#pragma once

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "picolo/host/json.hpp"

namespace picolo::tool {

enum class TableFormat { csv, json, nothing };

class SampleTable {
 public:
  SampleTable(std::vector<std::string> columns, TableFormat format);
  /// One value a column; null = not there (an empty field).
  void row(const std::vector<host::Json>& values);
  [[nodiscard]] std::size_t rows() const { return rows_; }

 private:
  std::vector<std::string> columns_;
  TableFormat format_;
  std::size_t rows_ = 0;
};

}  // namespace picolo::tool
