// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Text lines of a file, a .gz file or a pipe ("-"), with line numbers. What comes before the
/// damage of a damaged .gz is kept.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace picolo::host {

class ByteSource;

class LineReader {
 public:
  /// `path` "-" is standard input. gzip is recognised by its content, not by its name.
  /// Throws UserError (input) when the file cannot be opened.
  explicit LineReader(const std::string& path);
  ~LineReader();
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// False at the end. The view, without its line ending, is valid until the next call.
  /// The unfinished last line of a damaged file is not delivered: it may be cut within a number.
  bool next(std::string_view& line);

  /// The number of the line last delivered, from 1.
  [[nodiscard]] std::size_t line_number() const { return line_number_; }
  /// For messages: the path, or "standard input".
  [[nodiscard]] const std::string& name() const { return name_; }
  /// After the last line: why the end was not the true one; empty when all is well.
  [[nodiscard]] const std::string& damage() const;

 private:
  bool refill();

  std::string name_;
  std::unique_ptr<ByteSource> source_;
  std::string buffer_;
  std::size_t begin_ = 0;
  std::size_t line_number_ = 0;
};

}  // namespace picolo::host
