// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <zlib.h>

#include <array>
#include <cstdio>
#include <memory>
#include <string>

namespace picolo::host {

/// Bytes of a plain or gzip-compressed stream. zlib's own gz functions lose up to a buffer of good
/// bytes before a damaged one, hence inflate() directly.
class ByteSource {
 public:
  /// Throws UserError (input).
  explicit ByteSource(const std::string& path);
  ~ByteSource();
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;

  /// Appends some bytes to `out`; false when there are no more.
  bool append_to(std::string& out);
  [[nodiscard]] const std::string& damage() const { return damage_; }

 private:
  struct CloseFile {
    void operator()(std::FILE* file) const;
  };

  bool load();
  bool inflate_some(std::string& out);

  std::unique_ptr<std::FILE, CloseFile> file_;
  std::array<unsigned char, 1U << 16U> input_{};
  std::size_t input_begin_ = 0;
  std::size_t input_end_ = 0;
  z_stream stream_{};
  bool compressed_ = false;
  bool in_member_ = false;
  bool ended_ = false;
  std::string damage_;
};

}  // namespace picolo::host
