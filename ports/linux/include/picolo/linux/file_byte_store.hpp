// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// A file with the manners of NOR flash.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "picolo/hal/byte_store.hpp"
#include "picolo/linux/file_descriptor.hpp"

namespace picolo::inline v0 {

struct FileByteStoreConfig {
  ByteStoreGeometry geometry{.size = 65'536, .sector = 4096, .granule = 8};
  /// Wait for the disk after each program and erase (milliseconds): a power cut then leaves at most
  /// the last of them torn. Without it a crash of the program loses nothing, but a power cut may
  /// lose or reorder what was written last.
  bool durable = true;
  [[nodiscard]] constexpr bool valid() const {
    return geometry.sector > 0 && geometry.granule > 0 && geometry.sector % geometry.granule == 0 &&
           geometry.size >= geometry.sector && geometry.size % geometry.sector == 0;
  }
};

/// The file is exactly `geometry.size` bytes. Programming clears bits in what the file holds. Two
/// processes must not share it: the second `open` is refused.
class FileByteStore final : public ByteStore {
 public:
  explicit FileByteStore(const FileByteStoreConfig& config = {}) : config_(config) {}

  /// Opens the file, or makes it, erased. A new file appears complete or not at all.
  /// `invalid_argument`: the configuration is not valid. `corrupt`: the file has another size.
  /// `not_ready`: another process holds it. `io_error`: errno says why.
  Status open(const char* path);
  [[nodiscard]] bool is_open() const { return file_.is_open(); }

  [[nodiscard]] ByteStoreGeometry geometry() const override { return config_.geometry; }
  Status read(std::size_t address, std::span<std::uint8_t> bytes) override;
  Status program(std::size_t address, std::span<const std::uint8_t> bytes) override;
  Status erase(std::size_t address) override;

 private:
  [[nodiscard]] bool inside(std::size_t address, std::size_t size) const;
  Status create(const char* path) const;
  Status finish() const;

  FileByteStoreConfig config_;
  FileDescriptor file_{};
};

}  // namespace picolo::inline v0
