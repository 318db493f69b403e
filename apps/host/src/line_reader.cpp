// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "picolo/host/line_reader.hpp"

#include "byte_source.hpp"

namespace picolo::host {

LineReader::LineReader(const std::string& path)
    : name_{path == "-" ? "standard input" : path}, source_{std::make_unique<ByteSource>(path)} {}

LineReader::~LineReader() = default;

bool LineReader::refill() {
  buffer_.erase(0, begin_);
  begin_ = 0;
  return source_->append_to(buffer_);
}

bool LineReader::next(std::string_view& line) {
  std::size_t searched = begin_;
  std::size_t end = buffer_.find('\n', searched);
  while (end == std::string::npos) {
    searched = buffer_.size() - begin_;
    if (!refill()) { break; }
    end = buffer_.find('\n', searched);
  }
  const bool finished = end != std::string::npos;
  if (!finished && (buffer_.empty() || !source_->damage().empty())) { return false; }
  line = std::string_view{buffer_}.substr(begin_, finished ? end - begin_ : std::string::npos);
  begin_ = finished ? end + 1 : buffer_.size();
  if (!line.empty() && line.back() == '\r') { line.remove_suffix(1); }
  ++line_number_;
  return true;
}

const std::string& LineReader::damage() const {
  return source_->damage();
}

}  // namespace picolo::host
