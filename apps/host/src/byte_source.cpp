// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
#include "byte_source.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <cstring>

#include "picolo/host/error.hpp"

namespace picolo::host {
namespace {

constexpr int kGzipOnly = 15 + 16;  // inflateInit2: window bits + gzip wrapper
constexpr unsigned char kMagic0 = 0x1F;
constexpr unsigned char kMagic1 = 0x8B;

std::FILE* open_or_throw(const std::string& path) {
  if (path == "-") { return stdin; }
  struct stat info {};
  if (::stat(path.c_str(), &info) == 0 && S_ISDIR(info.st_mode)) {
    throw UserError{ExitCode::input, path, "is a folder", "name a file in it"};
  }
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr) {
    const int reason = errno;
    throw UserError{ExitCode::input, path,
                    std::string{"cannot be opened: "} + std::strerror(reason),
                    reason == ENOENT ? "check the path" : "check its permissions"};
  }
  return file;
}

}  // namespace

void ByteSource::CloseFile::operator()(std::FILE* file) const {
  if (file != nullptr && file != stdin) { std::fclose(file); }
}

ByteSource::ByteSource(const std::string& path) : file_{open_or_throw(path)} {
  while (input_end_ < 2 && load()) {}
  compressed_ = input_end_ >= 2 && input_[0] == kMagic0 && input_[1] == kMagic1;
  if (compressed_) { in_member_ = inflateInit2(&stream_, kGzipOnly) == Z_OK; }
}

ByteSource::~ByteSource() {
  if (compressed_) { inflateEnd(&stream_); }
}

/// Reads behind what is in the input buffer; false at the end of the file.
bool ByteSource::load() {
  if (input_begin_ == input_end_) {
    input_begin_ = 0;
    input_end_ = 0;
  }
  const std::size_t got =
      std::fread(input_.data() + input_end_, 1, input_.size() - input_end_, file_.get());
  input_end_ += got;
  if (got == 0 && std::ferror(file_.get()) != 0) {
    damage_ = std::string{"reading failed: "} + std::strerror(errno);
  }
  return got > 0;
}

bool ByteSource::append_to(std::string& out) {
  const std::size_t before = out.size();
  while (!ended_ && out.size() == before) {
    const bool dry = input_begin_ == input_end_ && !load();
    if (!compressed_) {
      out.append(input_.begin() + input_begin_, input_.begin() + input_end_);
      input_begin_ = input_end_;
      ended_ = dry;
    } else if (dry) {
      // zlib may still hold output for which there was no room
      const bool member_was_open = in_member_;
      ended_ = !member_was_open || !inflate_some(out) || (in_member_ && out.size() == before);
      if (ended_ && in_member_ && damage_.empty()) {
        damage_ = "the compressed file ends too early (truncated)";
      }
    } else {
      ended_ = !inflate_some(out);
    }
  }
  return out.size() > before;
}

/// False when nothing behind this point can be read.
bool ByteSource::inflate_some(std::string& out) {
  if (!in_member_) {
    // gzip members may follow each other (cat a.gz b.gz); zero padding may follow the last one
    while (input_begin_ < input_end_ && input_[input_begin_] == 0) { ++input_begin_; }
    if (input_begin_ == input_end_) { return true; }
    inflateReset(&stream_);
    in_member_ = true;
  }
  const std::size_t before = out.size();
  constexpr std::size_t kChunk = 1U << 16U;
  out.resize(before + kChunk);
  stream_.next_in = input_.data() + input_begin_;
  stream_.avail_in = static_cast<uInt>(input_end_ - input_begin_);
  stream_.next_out = reinterpret_cast<Bytef*>(out.data() + before);
  stream_.avail_out = kChunk;
  const int status = inflate(&stream_, Z_NO_FLUSH);
  out.resize(out.size() - stream_.avail_out);
  input_begin_ = input_end_ - stream_.avail_in;
  if (status == Z_STREAM_END) {
    in_member_ = false;
    return true;
  }
  if (status != Z_OK && status != Z_BUF_ERROR) {
    damage_ = std::string{"the compressed data is damaged ("} +
              (stream_.msg != nullptr ? stream_.msg : "unknown") + ")";
    return false;
  }
  return true;
}

}  // namespace picolo::host
