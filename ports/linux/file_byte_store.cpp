// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0

#include "picolo/linux/file_byte_store.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace picolo::inline v0 {
namespace {

constexpr std::size_t kBlock = 512;
using Block = std::array<std::uint8_t, kBlock>;

bool read_all(int fd, std::size_t address, std::span<std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::pread(fd, bytes.data(), bytes.size(), static_cast<off_t>(address));
    if (count < 0 && errno == EINTR) { continue; }
    if (count <= 0) { return false; }
    address += static_cast<std::size_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

bool write_all(int fd, std::size_t address, std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::pwrite(fd, bytes.data(), bytes.size(), static_cast<off_t>(address));
    if (count < 0 && errno == EINTR) { continue; }
    if (count <= 0) { return false; }
    address += static_cast<std::size_t>(count);
    bytes = bytes.subspan(static_cast<std::size_t>(count));
  }
  return true;
}

bool fill_erased(int fd, std::size_t address, std::size_t size) {
  Block block;
  block.fill(0xFF);
  for (std::size_t done = 0; done < size; done += kBlock) {
    const std::size_t part = std::min(kBlock, size - done);
    if (!write_all(fd, address + done, std::span{block}.first(part))) { return false; }
  }
  return true;
}

}  // namespace

Status FileByteStore::open(const char* path) {
  file_.close();
  if (!config_.valid()) { return Status::invalid_argument; }
  FileDescriptor file{::open(path, O_RDWR | O_CLOEXEC)};
  if (!file.is_open() && errno == ENOENT) {
    const Status status = create(path);
    if (!is_ok(status)) { return status; }
    file = FileDescriptor{::open(path, O_RDWR | O_CLOEXEC)};
  }
  if (!file.is_open()) { return Status::io_error; }
  if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) { return Status::not_ready; }
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) { return Status::io_error; }
  if (info.st_size != static_cast<off_t>(config_.geometry.size)) { return Status::corrupt; }
  file_ = std::move(file);
  return Status::ok;
}

/// Under another name first: a crash on the way leaves no half-made store.
Status FileByteStore::create(const char* path) const {
  std::array<char, 4096> name{};
  const int length = ::snprintf(name.data(), name.size(), "%s.new", path);
  if (length < 0 || static_cast<std::size_t>(length) >= name.size()) {
    return Status::invalid_argument;
  }
  const FileDescriptor file{::open(name.data(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
  const bool written = file.is_open() && fill_erased(file.get(), 0, config_.geometry.size) &&
                       ::fsync(file.get()) == 0 && ::rename(name.data(), path) == 0;
  return written ? Status::ok : Status::io_error;
}

Status FileByteStore::read(std::size_t address, std::span<std::uint8_t> bytes) {
  if (!inside(address, bytes.size())) { return Status::out_of_range; }
  return read_all(file_.get(), address, bytes) ? Status::ok : Status::io_error;
}

Status FileByteStore::program(std::size_t address, std::span<const std::uint8_t> bytes) {
  if (!inside(address, bytes.size())) { return Status::out_of_range; }
  const std::size_t granule = config_.geometry.granule;
  if (address % granule != 0 || bytes.size() % granule != 0) { return Status::invalid_argument; }
  Block block;
  while (!bytes.empty()) {
    const std::span<std::uint8_t> part = std::span{block}.first(std::min(kBlock, bytes.size()));
    if (!read_all(file_.get(), address, part)) { return Status::io_error; }
    for (std::size_t i = 0; i < part.size(); ++i) {
      part[i] = static_cast<std::uint8_t>(part[i] & bytes[i]);
    }
    if (!write_all(file_.get(), address, part)) { return Status::io_error; }
    address += part.size();
    bytes = bytes.subspan(part.size());
  }
  return finish();
}

Status FileByteStore::erase(std::size_t address) {
  if (!inside(address, config_.geometry.sector)) { return Status::out_of_range; }
  if (address % config_.geometry.sector != 0) { return Status::invalid_argument; }
  if (!fill_erased(file_.get(), address, config_.geometry.sector)) { return Status::io_error; }
  return finish();
}

bool FileByteStore::inside(std::size_t address, std::size_t size) const {
  const std::size_t end = config_.geometry.size;
  return address <= end && size <= end - address;
}

Status FileByteStore::finish() const {
  if (config_.durable && ::fdatasync(file_.get()) != 0) { return Status::io_error; }
  return Status::ok;
}

}  // namespace picolo::inline v0
